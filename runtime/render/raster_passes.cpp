#include <algorithm>
#include <cstddef>

#include "runtime/render/view_state.h"

namespace froth {
namespace {

// The tiles of a cell do not depend on its place in the order, so they are counted while the first digit is
// sorted.
void recordCellSort(const Recording& recording, const PassRecorder& recorder) {
  const ViewBuffers& buffers = recording.view.buffers;
  const TallyLayout tallies = layOutTallies(buffers.capacity());
  const VkDeviceAddress counters = recording.countersAddress();
  recorder.runIndirect(Pass::kCountTiles, offsetof(gpu::Counters, tileDispatch));
  recordSort(recorder,
             {buffers[ViewBuffer::kCellKeys].address, buffers[ViewBuffer::kOrder].address,
              buffers[ViewBuffer::kCellKeysSwap].address, buffers[ViewBuffer::kOrderSwap].address,
              counters + offsetof(gpu::Counters, visibleCells),
              buffers[ViewBuffer::kTallies].address + tallies.cellHistograms, buffers.capacity().cells,
              offsetof(gpu::Counters, cellSortDispatch)},
             kCellKeyDigits, gpu::kSortTakeTileCounts);
}

// Pairs leave the cells in their order; a stable sort by tile keeps it within each tile.
void recordBin(const Recording& recording, const PassRecorder& recorder) {
  const ViewBuffers& buffers = recording.view.buffers;
  const TallyLayout tallies = layOutTallies(buffers.capacity());
  const VkDeviceAddress counters = recording.countersAddress();
  recorder.runIndirect(Pass::kEmitPairs, offsetof(gpu::Counters, tileDispatch));
  recorder.wait();
  recordSort(recorder,
             {buffers[ViewBuffer::kPairTiles].address, buffers[ViewBuffer::kPairCells].address,
              buffers[ViewBuffer::kPairTilesSwap].address, buffers[ViewBuffer::kPairCellsSwap].address,
              counters + offsetof(gpu::Counters, pairsKept),
              buffers[ViewBuffer::kTallies].address + tallies.pairHistograms, buffers.capacity().pairs,
              offsetof(gpu::Counters, pairSortDispatch)},
             digitsOf(tilesOf(recording.info.camera.scissor)), gpu::kSortFindRanges);
}

// A workgroup per sub-tile, 16 in a row for each place in the order of the tiles.
void recordTiles(const Recording& recording, const PassRecorder& recorder) {
  constexpr uint32_t kAlong = gpu::kTileSize / gpu::kSubTileSize;
  const uint32_t tiles = tilesOf(recording.info.camera.scissor);
  constexpr uint32_t kTilesPerRow = 2048;  // one dimension may be limited to 65535 workgroups
  recorder.run(pixelPass(Pass::kRaster16, recording.info), kAlong * kAlong * std::min(tiles, kTilesPerRow),
               groupsOver(tiles, kTilesPerRow));
}

}  // namespace

void recordRasterPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  recordCull(recorder, asset);
  recording.mark("cull");
  recordCellSort(recording, recorder);
  recording.mark("sort");
  recordBin(recording, recorder);
  recording.mark("bin");
  recorder.run(Pass::kOrderTiles, 1);  // beside the shading
  recordShade(recorder);
  recording.mark("shade");
  recordTiles(recording, recorder);
  recording.mark("raster");
}

}  // namespace froth
