#include <algorithm>
#include <cstddef>

#include "runtime/render/view_state.h"

namespace froth {
namespace {

SortArrays cellSortOf(const RecordingPart& part) {
  const ViewBuffers& buffers = part.space.buffers;
  const VkDeviceAddress counters = buffers[ViewBuffer::kCounters].address + part.recorder.countersOffset;
  const uint32_t capacity = buffers.capacity().cells;
  return {buffers[ViewBuffer::kCellKeys].address,
          buffers[ViewBuffer::kOrder].address,
          buffers[ViewBuffer::kCellKeysSwap].address,
          buffers[ViewBuffer::kOrderSwap].address,
          counters + offsetof(gpu::Counters, visibleCells),
          buffers[ViewBuffer::kTallies].address + buffers.tallies().cellHistograms,
          capacity,
          buffers.sortRounds(),
          offsetof(gpu::Counters, cellSortDispatch)};
}

SortArrays pairSortOf(const RecordingPart& part) {
  const ViewBuffers& buffers = part.space.buffers;
  const VkDeviceAddress counters = buffers[ViewBuffer::kCounters].address + part.recorder.countersOffset;
  return {buffers[ViewBuffer::kPairTiles].address,
          buffers[ViewBuffer::kPairCells].address,
          buffers[ViewBuffer::kPairTilesSwap].address,
          buffers[ViewBuffer::kPairCellsSwap].address,
          counters + offsetof(gpu::Counters, pairsKept),
          buffers[ViewBuffer::kTallies].address + buffers.tallies().pairHistograms,
          buffers.capacity().pairs,
          buffers.sortRounds(),
          offsetof(gpu::Counters, pairSortDispatch)};
}

void recordTileTests(const Recording& recording, Pass pass) {
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.runIndirect(pass, offsetof(gpu::Counters, tileDispatch));
  }
}

// The passes of a sort leave most of the GPU idle, so what does not depend on the order runs beside them.
void recordCellSort(const Recording& recording) {
  for (uint32_t digit = 0; digit < kCellKeyDigits; ++digit) {
    const uint32_t step = digit + 1 == kCellKeyDigits ? gpu::kSortTakeTileCounts : gpu::kSortCountNextDigit;
    for (const RecordingPart& part : recording.parts()) recordSortDigit(part.recorder, cellSortOf(part), digit, step);
    if (digit == 0) recordTileTests(recording, Pass::kCountTiles);
    if (digit == 1) recordExpand(recording);
    if (digit == 2) recordShade(recording);
    recording.wait();
  }
}

// Pairs leave the cells in their order; a stable sort by tile keeps it within each tile.
void recordBin(const Recording& recording) {
  recordTileTests(recording, Pass::kEmitPairs);
  recording.wait();
  const uint32_t digits = tileDigits(tilesOf(recording.info.camera.scissor));
  for (uint32_t digit = 0; digit < digits; ++digit) {
    const uint32_t step = digit + 1 == digits ? gpu::kSortOnlyMove : gpu::kSortCountNextDigit;
    for (const RecordingPart& part : recording.parts()) {
      recordSortDigit(part.recorder, pairSortOf(part), digit, step);
      if (digit == 0) part.recorder.run(Pass::kOrderTiles, 1);
    }
    recording.wait();
  }
}

// Each instance draws the tiles in which it is alone; then come those that several share.
void recordTiles(const Recording& recording) {
  pushParts(recording);
  if (recording.parts().size() > 1) {
    const uint32_t groups = groupsOver(tilesOf(recording.info.camera.scissor), gpu::kGroupSize);
    recorderOf(recording, Pass::kShareTiles).run(Pass::kShareTiles, groups);
    recording.wait();
  }
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.runIndirect(pixelPass(Pass::kRasterLong16, recording.info),
                              offsetof(gpu::Counters, longTileDispatch));
    part.recorder.runIndirect(pixelPass(Pass::kRaster16, recording.info), offsetof(gpu::Counters, tileDrawDispatch));
  }
  if (recording.parts().size() == 1) return;
  recordPixels(recording, pixelPass(Pass::kRasterOrdered16, recording.info));
  const bool isAnyOverlapping = std::ranges::any_of(recording.parts(), [](const auto& p) { return p.overlaps != 0; });
  if (isAnyOverlapping) recordPixels(recording, pixelPass(Pass::kRasterMerged16, recording.info));
}

}  // namespace

void recordRasterPasses(const Recording& recording) {
  recording.run("cull", [&] { recordCull(recording); });
  recording.run("sort", [&] { recordCellSort(recording); });
  recording.run("bin", [&] { recordBin(recording); });
  recording.run("raster", [&] { recordTiles(recording); });
}

}  // namespace froth
