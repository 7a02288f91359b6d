#include <cstddef>

#include "runtime/render/view_state.h"

namespace froth {
namespace {

// The passes of a sort leave most of the GPU idle, so what does not depend on the order runs beside them.
void recordCellSort(const Recording& recording, const PassRecorder& recorder) {
  const ViewBuffers& buffers = recording.view.buffers;
  const TallyLayout tallies = layOutTallies(buffers.capacity());
  const VkDeviceAddress counters = recording.countersAddress();
  recordSort(recorder,
             {buffers[ViewBuffer::kCellKeys].address, buffers[ViewBuffer::kOrder].address,
              buffers[ViewBuffer::kCellKeysSwap].address, buffers[ViewBuffer::kOrderSwap].address,
              counters + offsetof(gpu::Counters, visibleCells),
              buffers[ViewBuffer::kTallies].address + tallies.cellHistograms, buffers.capacity().cells,
              sortRoundsOf(buffers.capacity().cells), offsetof(gpu::Counters, cellSortDispatch)},
             kCellKeyDigits, gpu::kSortTakeTileCounts, [&](uint32_t digit) {
               if (digit == 0) recorder.runIndirect(Pass::kCountTiles, offsetof(gpu::Counters, tileDispatch));
               if (digit == 1) recordExpand(recorder);
               if (digit == 2) recordShade(recorder);
             });
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
              sortRoundsOf(buffers.capacity().cells), offsetof(gpu::Counters, pairSortDispatch)},
             digitsOf(tilesOf(recording.info.camera.scissor)), gpu::kSortOnlyMove, [&](uint32_t digit) {
               if (digit == 0) recorder.run(Pass::kOrderTiles, 1);
             });
}

}  // namespace

void recordRasterPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  recordCull(recording, recorder, asset);
  recording.mark("cull");
  recordCellSort(recording, recorder);
  recording.mark("sort");
  recordBin(recording, recorder);
  recording.mark("bin");
  recorder.runIndirect(pixelPass(Pass::kRasterLong16, recording.info), offsetof(gpu::Counters, longTileDispatch));
  recorder.runIndirect(pixelPass(Pass::kRaster16, recording.info), offsetof(gpu::Counters, tileDrawDispatch));
  recording.mark("raster");
}

}  // namespace froth
