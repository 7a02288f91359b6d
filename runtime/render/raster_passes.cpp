#include <cstddef>

#include "runtime/render/view_state.h"

namespace froth {
namespace {

constexpr uint32_t kKeyDigits = 4;  // bytes of a cell's key

void recordCellSort(const Recording& recording, const PassRecorder& recorder) {
  const ViewBuffers& buffers = recording.view.buffers;
  const VkDeviceAddress counters = recording.countersAddress();
  recordSort(recorder,
             {buffers[ViewBuffer::kCellKeys].address, buffers[ViewBuffer::kOrder].address,
              buffers[ViewBuffer::kCellKeysSwap].address, buffers[ViewBuffer::kOrderSwap].address,
              counters + offsetof(gpu::Counters, visibleCells), buffers.capacity().cells,
              offsetof(gpu::Counters, cellSortDispatch)},
             kKeyDigits);
}

// Pairs leave the cells in their order; a stable sort by tile keeps it within each tile.
void recordBin(const Recording& recording, const PassRecorder& recorder) {
  const ViewBuffers& buffers = recording.view.buffers;
  const VkDeviceAddress counters = recording.countersAddress();
  recorder.runIndirect(Pass::kCountTiles, offsetof(gpu::Counters, visibleDispatch));
  recorder.wait();
  recorder.run(Pass::kScanGroups, 1, 1, gpu::kScanPairs);
  recorder.wait();
  recorder.runIndirect(Pass::kEmitPairs, offsetof(gpu::Counters, visibleDispatch));
  recorder.wait();
  recordSort(recorder,
             {buffers[ViewBuffer::kPairTiles].address, buffers[ViewBuffer::kPairCells].address,
              buffers[ViewBuffer::kPairTilesSwap].address, buffers[ViewBuffer::kPairCellsSwap].address,
              counters + offsetof(gpu::Counters, pairsKept), buffers.capacity().pairs,
              offsetof(gpu::Counters, pairSortDispatch)},
             tileDigits(recording.info.camera.scissor));
  recorder.runIndirect(Pass::kFindRanges, offsetof(gpu::Counters, pairDispatch));
  recorder.wait();
}

}  // namespace

void recordRasterPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  recordCull(recorder, asset);
  recording.mark("cull");
  recordCellSort(recording, recorder);
  recording.mark("sort");
  recordBin(recording, recorder);
  recording.mark("bin");
  recordShade(recorder);
  recording.mark("shade");
  recordPixels(recording, recorder, isWideColour(recording.info) ? Pass::kRaster32 : Pass::kRaster16);
  recording.mark("raster");
}

}  // namespace froth
