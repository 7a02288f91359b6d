// Chunks of assets with levels of detail, frame by frame: what views and stream points see, the budget, and what
// LevelStreaming makes of them.
#include <algorithm>
#include <cmath>

#include "runtime/context/context.h"
#include "runtime/render/border_pass.h"

namespace froth {
namespace {

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
  if (asset.before()) return;
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
  stepFade();
  assets_.forEachNamed([&](FrothAsset handle, Asset& asset) {
    if (!asset.hasLevels() || !asset.isDecoded() || asset.hasFailed()) return;
    const bool canTakePlan = asset.updateChunks(completedSerial_, completedUploadSerial_, ring_.get());
    if (canTakePlan && fadeStep_ == 1 && isRoomMadeFor(asset)) asset.takePlan(serial_, mostFadeFrames() > 0);
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

// What views need for the cells of an asset, told to levels_. Returns what they need of it whatever is drawn, and hold,
// [bytes].
Context::ViewShare Context::priceCells(FrothAsset handle, Asset& asset) {
  ViewShare share;
  uint64_t bytesPerCell = 0, mostBytes = 0;
  instances_.forEachNamed([&](FrothInstance name, const Instance& instance) {
    if (!isSame(instance.asset, handle)) return;
    views_.forEach([&](const View& view) {
      if (!view.renderer) return;
      const CutRoom room = view.renderer->roomForCuts(name, asset.gpu());
      share.fixedBytes += room.fixedBytes;
      share.heldBytes += room.heldBytes;
      bytesPerCell += room.bytesPerCell;
      mostBytes += room.bytesPerCell * room.mostCells;
    });
  });
  levels_.setViewPrice(handle, bytesPerCell, mostBytes);
  return share;
}

// Device memory of all but chunks of streamed assets and what views need for their cells. What is only ordered, or on
// its way back, does not count: it comes and goes with the cuts.
uint64_t Context::otherBytes() {
  uint64_t bytes = device_.ledger.deviceBytes(MemoryUse::kWalks);
  if (exchange_) bytes += exchange_->successor->heldBytes();
  for (const Replacement& replacement : replacements_) {
    bytes += replacement.successor ? replacement.successor->heldBytes() : 0;
  }
  views_.forEach([&](const View& view) { bytes += view.renderer ? view.renderer->heldBytes() : 0; });
  assets_.forEachNamed([&](FrothAsset handle, Asset& asset) {
    if (!levels_.has(handle)) {
      bytes += asset.heldBytes();
      return;
    }
    const ViewShare share = priceCells(handle, asset);
    bytes += asset.tableBytes() + share.fixedBytes;
    bytes -= share.heldBytes;
  });
  return bytes;
}

// What nothing else holds is for chunks of streamed assets and for what views need of them. Without a budget, and on a
// null device, there is no limit.
void Context::limitLevels() {
  levels_.setMostCells(streamCells_);
  const uint64_t others = otherBytes();
  const bool isLimited = device_.budget != 0 && !isNull_;
  const uint64_t room = device_.budget - std::min<uint64_t>(device_.budget, others);
  const bool isEnough = levels_.setBudget(isLimited ? shareBudget(room, levels_.needs()) : LevelShares{});
  assets_.forEachNamed([&](FrothAsset handle, Asset& asset) {
    if (levels_.has(handle)) asset.setMostCells(levels_.mostCells(handle));
  });
  if (!isEnough && !isFloorTold_) {
    messages.warn(
        FROTH_ERROR_MEMORY, "frothSetBudget",
        "%llu bytes remain for assets with levels of detail and what views need of them, and their floors take %llu: "
        "they show their floors alone; raise the budget of %llu, or close assets or views",
        asPrinted(room), asPrinted(levels_.floorBytes()), asPrinted(device_.budget));
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
