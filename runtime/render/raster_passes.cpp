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

}  // namespace

void recordRasterPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  recordCull(recording, recorder, asset);
  recording.mark("cull");
  recordCellSort(recording, recorder);
  recording.mark("sort");
  recordBin(recording, recorder);
  recording.mark("bin");
  recordShade(recorder);
  recording.mark("shade");
  recordPixels(recording, recorder, pixelPass(Pass::kRaster16, recording.info));
  recording.mark("raster");
}

}  // namespace froth
