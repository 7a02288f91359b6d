// An asset with fewer or more layers.
#include "runtime/asset/asset.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace froth {

// So many at most, and none at the end of which the file has nothing.
uint32_t Asset::layersHeld(uint32_t most) const {
  while (most > 1 && layerWork_[most - 1] == 0) --most;
  return most;
}

bool Asset::canLoadAgain() const { return !keepsLayers_ && (source_.kind != SourceKind::kMemory || source_.bytesStay); }

uint32_t Asset::fewerLayers() const { return canLoadAgain() && layers_ > 1 ? layersHeld(layers_ - 1) : 0; }

uint32_t Asset::moreLayers() const {
  if (!canLoadAgain() || !lacksLayers()) return 0;
  uint32_t more = layers_ + 1;
  while (layerWork_[more - 1] == 0) ++more;  // openedLayers_ has something
  return more;
}

VkDeviceSize Asset::bytesWith(uint32_t layers) const {
  const VkDeviceSize measured = figures_[layers - 1].bytes;
  if (measured != 0) return measured;
  const auto workOf = [&](uint32_t count) {
    return static_cast<double>(std::accumulate(layerWork_.begin(), layerWork_.begin() + count, uint64_t{0}));
  };
  return static_cast<VkDeviceSize>(static_cast<double>(heldBytes()) * workOf(layers) / std::max(workOf(layers_), 1.0));
}

std::shared_ptr<Asset> Asset::makeSuccessor(uint32_t layers) const {
  AssetSource source = source_;
  source.lastLayer = static_cast<Layer>(layers - 1);
  auto successor = std::make_shared<Asset>(std::move(source), device_);
  successor->arena_ = std::make_shared<GpuArena>(*device_, GpuArena::Limit::kNone);
  successor->keepsForQueries_ = keepsForQueries_;
  successor->keepsForWalks_ = keepsForWalks_;
  successor->preparedForWalks_ = preparedForWalks_;
  successor->queryFoam_ = queryFoam_;
  successor->layers_ = layers;
  successor->openedLayers_ = openedLayers_;
  successor->figures_ = figures_;
  return successor;
}

Status Asset::checkSucceeds(const Asset& old) const {
  const FrothAssetStatus &now = description_, &before = old.description_;
  if (now.chunkCount == 0) return {};  // its head is not read yet
  const bool isSame = now.cellCount == before.cellCount && now.liveCount == before.liveCount &&
                      now.chunkCount == before.chunkCount && now.cellBits == before.cellBits;
  if (isSame) return {};
  return makeError(ErrorKind::kBadInput, "%u cells in %u chunks, and %u in %u when it was opened: it is another scene",
                   now.cellCount, now.chunkCount, before.cellCount, before.chunkCount);
}

}  // namespace froth
