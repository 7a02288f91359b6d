// Layers of assets by the budget. Where it is short they go before cells of views do, where there is room they come
// back: one asset at a time loads once more with the next fewer or more layers, and is exchanged at the edge of a
// frame.
#include <algorithm>

#include "runtime/context/context.h"

namespace froth {
namespace {

// Blocks may leave more unused than they did when the asset was measured: this part of it at most.
constexpr VkDeviceSize kSparePart = 16;

// Of a successor of which heldBytes are there.
VkDeviceSize bytesToCome(const Asset& asset, uint32_t layers, VkDeviceSize heldBytes) {
  const VkDeviceSize bytes = asset.bytesWith(layers) + asset.bytesWith(layers) / kSparePart;
  return bytes - std::min(bytes, heldBytes);
}

}  // namespace

// ---- The exchange under way ----

// Its failure is a warning: the asset stays as it is.
void Context::loadSuccessor(LoadLimit& limit, const Asset::Preparation& prepare) {
  if (!exchange_) {
    return;
  }
  Asset& successor = *exchange_->successor;
  Asset& old = *assets_.find(exchange_->asset);
  if (successor.layers() > old.layers() &&
      bytesToCome(successor, successor.layers(), successor.heldBytes()) > device_.roomBytes()) {
    abandonExchange();
    return;
  }
  const Messages warnings{[](void* user, FrothSeverity, FrothResult code, const char* object, const char* text) {
                            static_cast<const Messages*>(user)->warn(
                                code, object, "it keeps its layers, for it did not load once more: %s", text);
                          },
                          &messages};
  successor.load(jobs_, reads_, limit, prepare, warnings);
  const Status status = successor.hasFailed() ? Status() : successor.checkSucceeds(old);
  if (!status) {
    messages.warn(resultOf(status.error()), old.name().c_str(), "it keeps its layers: %s; close it and open it again",
                  status.error().message.c_str());
  }
  if (!status || successor.hasFailed()) {
    old.keepLayers();
    abandonExchange();
  }
}

// Its copies are complete, so that no dropped frame takes them back.
void Context::finishExchange() {
  if (!exchange_) {
    return;
  }
  Asset& successor = *exchange_->successor;
  if (!successor.isDecoded() || successor.queuedBytes() > 0 || !ring_->isWithin(&successor, completedUploadSerial_)) {
    return;
  }
  const Asset& old = *assets_.find(exchange_->asset);
  retired_.reserve(retired_.size() + 1);
  if (successor.layers() < old.layers()) {
    messages.warn(
        FROTH_ERROR_MEMORY, old.name().c_str(),
        "layers: %u instead of %u, which takes %llu instead of %llu bytes, for the budget of %llu; they return "
        "where it has room; raise it, or close other assets or views",
        successor.layers(), old.layers(), asPrinted(successor.heldBytes()), asPrinted(old.heldBytes()),
        asPrinted(device_.budget));
  }
  const std::shared_ptr<Asset> replaced = assets_.replace(exchange_->asset, std::move(exchange_->successor));
  ring_->forget(replaced.get(), replaced);
  retire(replaced);
  exchange_.reset();
}

void Context::abandonExchange() {
  retired_.reserve(retired_.size() + 1);
  ring_->forget(exchange_->successor.get(), exchange_->successor);
  exchange_->successor->stop();
  retire(std::move(exchange_->successor));
  exchange_.reset();
}

// What has begun to give layers up ends, for views may look elsewhere for a moment; unless the budget was raised and
// has room for all. Layers return only as long as nobody else wants their room.
bool Context::isExchangeWanted() const {
  const Asset &old = *assets_.find(exchange_->asset), &successor = *exchange_->successor;
  if (successor.layers() > old.layers()) {
    return hasRoomFor(old, successor.layers(), successor.heldBytes());
  }
  const bool isRaised = device_.budget == 0 || device_.budget > exchange_->budget;
  return !isRaised || device_.excessBytes() > 0 || isBudgetShort();
}

// ---- The next one ----

// At the end of frothUpdate, when views have what they get. What is freed is waited for, so that each step is chosen by
// what the one before has brought.
void Context::chooseExchange() {
  if (!ring_) {
    return;
  }
  if (exchange_) {
    if (!isExchangeWanted()) {
      abandonExchange();
    }
    return;
  }
  if (isMemoryReturning()) {
    return;
  }
  const bool isShort = isBudgetShort();
  const std::optional<FrothAsset> handle = isShort ? findLayersToGive() : findLayersToTake();
  if (!handle) {
    tellExcess();
    return;
  }
  const Asset& asset = *assets_.find(*handle);
  exchange_ =
      Exchange{*handle, asset.makeSuccessor(isShort ? asset.fewerLayers() : asset.moreLayers()), device_.budget};
}

// [bytes] of buffers of views that lack space; with so many detail sites per cell of one asset.
VkDeviceSize Context::missingBytes(const Asset* exchanged, uint32_t detailCount) const {
  VkDeviceSize bytes = 0;
  views_.forEach([&](const View& view) {
    for (const RenderInstance& instance : view.prepared) {
      const bool isExchanged = exchanged && instance.asset == &exchanged->gpu();
      bytes += view.renderer->missingBytes(instance, isExchanged ? detailCount : instance.asset->detailCount);
    }
  });
  return bytes;
}

bool Context::isBudgetShort() const {
  return missingBytes() > device_.roomBytes() + device_.orderedBytes() ||
         (device_.excessBytes() > 0 && shrinkableBytes() == 0);
}

// For what of a successor with more layers is to come, and for what views then want, beside all that is held. The old
// asset goes afterwards: by so much the demand must grow before layers go again.
bool Context::hasRoomFor(const Asset& asset, uint32_t layers, VkDeviceSize heldBytes) const {
  const VkDeviceSize wanted =
      bytesToCome(asset, layers, heldBytes) + missingBytes(&asset, asset.detailCountWith(layers));
  return device_.excessBytes() == 0 && missingBytes() == 0 && wanted <= device_.roomBytes();
}

// View dependence of all assets goes before detail of any; among equals goes what frees most.
std::optional<FrothAsset> Context::findLayersToGive() const {
  std::optional<FrothAsset> found;
  uint32_t mostLayers = 0;
  VkDeviceSize mostFreed = 0;
  assets_.forEachNamed([&](FrothAsset handle, const Asset& asset) {
    if (asset.fewerLayers() == 0 || stateOf(asset) != FROTH_ASSET_READY) {
      return;
    }
    const VkDeviceSize freed = asset.heldBytes() - std::min(asset.heldBytes(), asset.bytesWith(asset.fewerLayers()));
    if (asset.layers() > mostLayers || (asset.layers() == mostLayers && freed > mostFreed)) {
      found = handle;
      mostLayers = asset.layers();
      mostFreed = freed;
    }
  });
  return found;
}

// The other way around.
std::optional<FrothAsset> Context::findLayersToTake() const {
  std::optional<FrothAsset> found;
  uint32_t fewestLayers = UINT32_MAX;
  VkDeviceSize fewestBytes = 0;
  assets_.forEachNamed([&](FrothAsset handle, const Asset& asset) {
    const uint32_t layers = asset.moreLayers();
    if (layers == 0 || stateOf(asset) != FROTH_ASSET_READY || !hasRoomFor(asset, layers, 0)) {
      return;
    }
    const VkDeviceSize bytes = asset.bytesWith(layers);
    if (layers < fewestLayers || (layers == fewestLayers && bytes < fewestBytes)) {
      found = handle;
      fewestLayers = layers;
      fewestBytes = bytes;
    }
  });
  return found;
}

void Context::tellExcess() {
  if (device_.excessBytes() == 0 || shrinkableBytes() > 0 || isExcessTold_) {
    return;
  }
  isExcessTold_ = true;
  messages.warn(FROTH_ERROR_MEMORY, "frothSetBudget",
                "%llu bytes are held and the budget is %llu: assets, but for layers that may go "
                "(FrothAssetInfo::layersMayGo), and the least that views need, do not shrink; close some, or raise it",
                asPrinted(device_.ledger.deviceBytes()), asPrinted(device_.budget));
}

}  // namespace froth
