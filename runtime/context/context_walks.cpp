// The calls of rays on the GPU: order of calls, numbers checked, defaults resolved, instances gathered.
#include <algorithm>
#include <cmath>

#include "runtime/context/context.h"
#include "runtime/context/info_checks.h"
#include "runtime/context/walk_limits.h"
#include "runtime/render/view_capacity.h"

namespace froth {
namespace {

// Tables of chunks that an instance needs in a frame which seeds its asset (walk_sets.cpp).
constexpr uint32_t kTablesToSeed = 2;

}  // namespace

FrothResult Context::checkWalks(const char* call) const {
  if (!hasWalkShaders_) {
    return messages.fail(FROTH_ERROR_STATE, call, "FrothContextInfo::walkShaders: 0; set it to 1");
  }
  return checkDevice(call);
}

FrothResult Context::describeWalkLayout(VkDescriptorSetLayout& layout) const {
  layout = VK_NULL_HANDLE;
  const FrothResult result = checkWalks("frothGetWalkSetLayout");
  if (result == FROTH_OK && walks_) {
    layout = walks_->layout();
  }
  return result;
}

// Of all that can be walked now or next.
uint32_t Context::walkedChunks() const {
  uint32_t chunkCount = 0;
  instances_.forEach([&](const Instance& instance) {
    const Asset& asset = *assets_.find(instance.asset);
    if (asset.isDecoded() && asset.gpu().walkEntries != 0) {
      chunkCount += kTablesToSeed * tableChunks(asset.gpu());
    }
  });
  return chunkCount;
}

// Space for all that can be walked; what does not fit is left out of sets.
void Context::prepareWalks() {
  if (!walks_) {
    return;
  }
  walked_.reserve(FROTH_WALK_MOST_INSTANCES);
  const Status status = walks_->prepare(completedSerial_, walkedChunks());
  if (status || device_.loss->isTold()) {  // of the loss frothUpdate tells
    walkError_.clear();
  } else if (!isPending(status) && walkError_ != status.error().message) {  // once, not in every frame
    walkError_ = status.error().message;
    messages.fail(status.error(), "walk set");
  }
}

bool Context::gatherWalked() {
  walked_.clear();
  bool isWhole = true;
  uint32_t chunkCount = 0;
  instances_.forEach([&](const Instance& instance) {
    const Asset& asset = *assets_.find(instance.asset);
    const bool isReady = stateOf(asset) == FROTH_ASSET_READY;
    if (isReady && asset.gpu().liveCount == 0) {
      return;  // nothing to be met
    }
    const uint32_t newCount = chunkCount + kTablesToSeed * static_cast<uint32_t>(asset.gpu().chunks.size());
    if (!isReady || asset.gpu().walkEntries == 0 || walked_.size() == FROTH_WALK_MOST_INSTANCES ||
        !walks_->hasSpaceFor(newCount)) {
      isWhole = false;
      return;
    }
    chunkCount = newCount;
    walked_.push_back({instance.placement, instance.mask, asset.entriesSerial != 0});
    walked_.back().placement.asset = &asset.gpu();
  });
  return isWhole;
}

FrothResult Context::recordWalkSet(VkCommandBuffer commandBuffer, FrothWalkInfo info, VkDescriptorSet& set) {
  constexpr const char* kCall = "frothRecordWalkSet";
  if (const FrothResult result = checkWalks(kCall); result != FROTH_OK) {
    return result;
  }
  if (serial_ == 0 || (walks_ && walks_->isRecorded(serial_))) {
    return messages.fail(FROTH_ERROR_STATE, kCall, "%s; call frothUpdate first",
                         serial_ == 0 ? "no frame" : "already recorded in this frame");
  }
  if (info.cutoff == 0) info.cutoff = kDefaultCutoff;
  if (info.quantile == 0) info.quantile = kDefaultQuantile;
  resolveWalkLimits(info.maxSteps, info.maxNeighbours);
  if (info.stages == 0) {
    info.stages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    if (device_.hasGraphics) info.stages |= VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  }
  if (!(info.quantile > 0 && info.quantile < 1) || !(info.cutoff < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "quantile: %g, cutoff: %g; must lie between 0 and 1, below 1",
                         double{info.quantile}, double{info.cutoff});
  }
  for (const double part : info.eye) {
    if (!std::isfinite(part)) {
      return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "eye: %g; must be finite", part);
    }
  }
  if (isNull_) {
    return FROTH_OK;
  }
  if (!commandBuffer) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "commandBuffer: null");
  }
  publishBorders(commandBuffer);
  const bool isWhole = gatherWalked();
  assets_.forEach([&](Asset& asset) {
    const auto isIts = [&](const WalkedInstance& instance) { return instance.placement.asset == &asset.gpu(); };
    const auto walked = std::ranges::find_if(walked_, isIts);
    if (walked != walked_.end()) walked->toFill = asset.fillPrepared(serial_, uploadBytesLeft_);
  });
  set = walks_->record(commandBuffer, info, walked_, serial_);
  assets_.forEach([&](Asset& asset) {
    for (const WalkedInstance& instance : walked_) {
      if (instance.placement.asset == &asset.gpu() && !instance.isSeeded) asset.entriesSerial = serial_;
    }
  });
  return isWhole ? FROTH_OK : FROTH_INCOMPLETE;
}

FrothResult Context::recordRays(VkCommandBuffer commandBuffer, VkDeviceAddress rays, VkDeviceAddress hits,
                                uint32_t count, FrothRayKind kind) {
  constexpr const char* kCall = "frothRecordRays";
  if (const FrothResult result = checkWalks(kCall); result != FROTH_OK || isNull_) {
    return result;
  }
  if (!walks_->isRecorded(serial_) || serial_ == 0) {
    return messages.fail(FROTH_ERROR_STATE, kCall, "no walk set in this frame; call frothRecordWalkSet first");
  }
  if (kind < FROTH_RAY_TRANSMITTANCE || kind > FROTH_RAY_RADIANCE) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "kind: %d; must be a FrothRayKind", static_cast<int>(kind));
  }
  if (count == 0) {
    return FROTH_OK;
  }
  constexpr VkDeviceAddress kAlignment = 16;
  if (!commandBuffer || rays == 0 || hits == 0 || rays % kAlignment != 0 || hits % kAlignment != 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "commandBuffer, rays, hits: null, or not a multiple of 16");
  }
  walks_->recordRays(commandBuffer, rays, hits, count, kind);
  return FROTH_OK;
}

FrothResult Context::describeWalks(FrothWalkStatus& status) const {
  const FrothResult result = checkWalks("frothGetWalkStatus");
  if (result == FROTH_OK && walks_) {
    status = walks_->status();
  }
  return result;
}

}  // namespace froth
