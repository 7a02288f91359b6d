// Cells prepared for rays, by the budget: they go before anything else does, and come once all else has what it wants.
#include <algorithm>

#include "runtime/context/context.h"

namespace froth {

// [bytes] that the budget leaves for them beside what all else holds and wants.
VkDeviceSize Context::roomForPrepared() {
  if (device_.budget == 0) {
    return UINT64_MAX;
  }
  if (isViewRefused_) {
    return 0;
  }
  VkDeviceSize wanted = otherBytes() + missingBytes();
  if (!levels_.isEmpty()) wanted += bytesForAll(levels_.needs());
  assets_.forEach([&](const Asset& asset) {
    if (asset.moreLayers() == 0) return;
    const VkDeviceSize held = asset.heldBytes();
    wanted += std::max(held, asset.bytesWith(asset.moreLayers())) - held;
  });
  return device_.budget - std::min(device_.budget, wanted);
}

// What was refused now will be there when they are gone.
bool Context::isPreparedInTheWay() const {
  bool isHeld = isPreparedLeaving_;
  assets_.forEach([&](const Asset& asset) { isHeld = isHeld || asset.isPreparing(); });
  return isHeld && device_.budget != 0;
}

// At the end of frothUpdate, when views and walk sets have what they get.
void Context::choosePrepared() {
  if (!walks_) {
    return;
  }
  isPreparedLeaving_ = isPreparedLeaving_ && isMemoryReturning();
  VkDeviceSize room = roomForPrepared();
  assets_.forEach([&](Asset& asset) {
    if (asset.preparedForm() == gpu::kPreparedNothing || !asset.isDecoded() || asset.hasFailed()) return;
    if (asset.isPreparingRefused()) return;
    const VkDeviceSize wanted = std::max(asset.preparedBytesWanted(), asset.preparedBytesHeld());
    if (wanted > room) {
      if (asset.isPreparing() || asset.awaitsPrepared()) dropPrepared(asset);
      return;
    }
    room -= wanted;
    if (!asset.isPreparing() && wanted > device_.roomBytes()) {
      if (asset.awaitsPrepared() && !isMemoryReturning()) dropPrepared(asset);
      return;
    }
    if (!asset.isPreparing()) asset.beginPreparing();
    const Status status = asset.placePrepared();
    if (!status && !isPending(status) && !device_.loss->isTold()) refusePrepared(asset, status.error());
  });
}

// Of as many assets as hold so many bytes. False: there are none.
bool Context::dropPrepared(VkDeviceSize bytes) {
  VkDeviceSize dropped = 0;
  assets_.forEach([&](Asset& asset) {
    if (dropped >= bytes || asset.preparedBytesHeld() == 0) return;
    dropped += asset.preparedBytesHeld();
    dropPrepared(asset);
  });
  return dropped > 0;
}

void Context::dropPrepared(Asset& asset) {
  retired_.reserve(retired_.size() + 1);
  messages.warn(FROTH_ERROR_MEMORY, asset.name().c_str(),
                "its cells are not prepared for rays: that takes %llu bytes, for which the budget of %llu has no room "
                "beside all else; they are once it has; raise it, or close other assets or views",
                asPrinted(std::max(asset.preparedBytesWanted(), asset.preparedBytesHeld())), asPrinted(device_.budget));
  retire(asset.releasePrepared());
  isPreparedLeaving_ = true;
}

// Until the budget changes.
void Context::refusePrepared(Asset& asset, const Error& error) {
  retired_.reserve(retired_.size() + 1);
  messages.warn(resultOf(error), asset.name().c_str(), "its cells are not prepared for rays: %s",
                error.message.c_str());
  retire(asset.releasePrepared());
  asset.refusePreparing(true);
}

}  // namespace froth
