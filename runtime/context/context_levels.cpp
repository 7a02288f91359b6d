// Which chunks of assets with levels of detail are resident and drawn: all of level 0 if the budget has room for them
// when the floor is there, else the floor alone.
#include <algorithm>

#include "runtime/context/context.h"
#include "runtime/render/border_pass.h"

namespace froth {
namespace {

// What blocks may leave unused of what is estimated.
constexpr VkDeviceSize kSpareOfChunks = 16;

std::vector<uint32_t> chunksOfLevelZero(const AssetContents& manifest) {
  std::vector<uint32_t> chunks;
  for (uint32_t chunk = 0; chunk < manifest.levels.size(); ++chunk) {
    if (manifest.levels[chunk].level == 0) chunks.push_back(chunk);
  }
  return chunks;
}

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
  wantedCut(handle, *assets_.find(handle)) = std::move(chunks);
}

std::vector<uint32_t>& Context::wantedCut(FrothAsset handle, const Asset& asset) {
  const auto isIts = [&](const auto& cut) { return isSame(cut.first, handle); };
  if (const auto found = std::ranges::find_if(cuts_, isIts); found != cuts_.end()) return found->second;
  std::vector<uint32_t> cut = chunksOfLevelZero(asset.manifest());
  VkDeviceSize wanted = 0;
  for (const uint32_t chunk : cut) {
    if (asset.chunkState(chunk) == SlotState::kAbsent) wanted += asset.chunkBytes(chunk);
  }
  const std::span<const uint32_t> floor = asset.drawnChunks();
  if (wanted + wanted / kSpareOfChunks > device_.roomBytes()) cut.assign(floor.begin(), floor.end());
  return cuts_.emplace_back(handle, std::move(cut)).second;
}

void Context::updateLevels() {
  assets_.forEachNamed([&](FrothAsset handle, Asset& asset) {
    if (!asset.hasLevels() || !asset.isDecoded() || asset.hasFailed()) return;
    const bool canTakePlan = asset.updateChunks(completedSerial_, completedUploadSerial_, ring_.get());
    if (canTakePlan && isRoomMadeFor(asset)) asset.takePlan(serial_);
    followCut(asset, wantedCut(handle, asset));
  });
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
