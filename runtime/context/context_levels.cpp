// Chunks of assets with levels of detail, frame by frame: what views and stream points see, the budget, and what
// LevelStreaming makes of them.
#include <algorithm>
#include <cmath>

#include "runtime/context/context.h"
#include "runtime/render/border_pass.h"

namespace froth {
namespace {

// No budget: more than any device has.
constexpr uint64_t kNoBudget = uint64_t{1} << 62;

// Reads what a cut lacks, draws it when it is whole, and then gives up what is in no use.
void followCut(Asset& asset, const std::vector<uint32_t>& cut) {
  bool isResident = true;
  for (const uint32_t chunk : cut) {
    const SlotState state = asset.chunkState(chunk);
    if (state == SlotState::kAbsent) asset.readChunk(chunk);
    isResident = isResident && state == SlotState::kResident;
  }
  if (!isResident) return;
  if (!std::ranges::equal(cut, asset.drawnChunks())) {
    asset.planChunks(cut);
    return;
  }
  for (uint32_t chunk = 0; chunk < asset.manifest().levels.size(); ++chunk) {
    if (!std::ranges::binary_search(cut, chunk)) asset.evictChunk(chunk);
  }
}

}  // namespace

void Context::setCut(FrothAsset handle, std::vector<uint32_t> chunks) {
  levels_.remove(handle);
  const auto isIts = [&](const auto& cut) { return isSame(cut.first, handle); };
  std::erase_if(cuts_, isIts);
  cuts_.emplace_back(handle, std::move(chunks));
}

void Context::updateLevels() {
  assets_.forEachNamed([&](FrothAsset handle, Asset& asset) {
    if (!asset.hasLevels() || !asset.isDecoded() || asset.hasFailed()) return;
    const bool canTakePlan = asset.updateChunks(completedSerial_, completedUploadSerial_, ring_.get());
    if (canTakePlan && isRoomMadeFor(asset)) asset.takePlan(serial_);
    const auto isIts = [&](const auto& cut) { return isSame(cut.first, handle); };
    if (const auto cut = std::ranges::find_if(cuts_, isIts); cut != cuts_.end()) {
      followCut(asset, cut->second);
      return;
    }
    if (!levels_.has(handle)) levels_.add(handle, asset);
    levels_.report(handle, asset, messages);
    if (areEyesFrozen_) return;
    gatherEyes(handle, asset);
    levels_.setEyes(handle, streamEyes_);
  });
  if (levels_.isEmpty()) return;
  limitLevels();
  levels_.decide([&](FrothAsset handle) -> Asset& { return *assets_.find(handle); });
}

// Of all instances of an asset, into streamEyes_.
void Context::gatherEyes(FrothAsset handle, const Asset& asset) {
  streamEyes_.clear();
  const auto add = [&](const SeenFrom& from) {
    instances_.forEach([&](const Instance& instance) {
      if (!isSame(instance.asset, handle) || (from.mask != 0 && (from.mask & instance.mask) == 0)) return;
      streamEyes_.push_back(eyeOf(from, instance.placement, asset.gpu()));
    });
  };
  views_.forEach([&](const View& view) {
    for (const Eye& eye : view.eyes) {
      if (!eye.seenFrom) continue;
      SeenFrom from = *eye.seenFrom;
      from.detail = streamDetail_;
      add(from);
    }
  });
  for (const SeenFrom& point : streamPoints_) add(point);
}

// What chunks of streamed assets may take: half of the budget that nothing else holds. Blocks of memory leave up to 29
// % unused (GpuArena), and views grow with what is drawn.
void Context::limitLevels() {
  uint64_t budget = kNoBudget;
  if (device_.budget != 0 && !isNull_) {
    uint64_t others = device_.ledger.deviceBytes();
    assets_.forEachNamed([&](FrothAsset handle, const Asset& asset) {
      if (levels_.has(handle)) others -= std::min<uint64_t>(others, asset.heldBytes() - asset.tableBytes());
    });
    budget = (device_.budget - std::min<uint64_t>(device_.budget, others)) / 2;
  }
  levels_.setMostCells(streamCells_);
  const bool isEnough = levels_.setBudget(budget);
  if (!isEnough && !isFloorTold_) {
    messages.warn(
        FROTH_ERROR_MEMORY, "frothSetBudget",
        "%llu bytes remain for assets with levels of detail, and their floors take %llu: they show their floors "
        "alone; raise the budget of %llu, or close assets or views",
        asPrinted(budget), asPrinted(levels_.floorBytes()), asPrinted(device_.budget));
  }
  isFloorTold_ = !isEnough;
}

// Whether all views and walk sets that have the asset will have it with its next chunks: no frame is to miss it.
bool Context::isRoomMadeFor(const Asset& asset) const {
  bool isMade = !walks_ || walks_->hasSpaceFor(walkedChunks());
  views_.forEach([&](const View& view) {
    for (const RenderInstance& instance : view.prepared) {
      if (instance.asset == &asset.gpu()) isMade = isMade && view.renderer->coversNext(instance);
    }
  });
  return isMade;
}

void Context::publishBorders(VkCommandBuffer commandBuffer) {
  assets_.forEach([&](Asset& asset) {
    if (!asset.hasLevels() || !asset.gpu().hasWalkGraph || stateOf(asset) != FROTH_ASSET_READY) return;
    recordBorders(device_, *pipelines_, commandBuffer, asset.gpu(), asset.publishBorders(serial_));
  });
}

}  // namespace froth
