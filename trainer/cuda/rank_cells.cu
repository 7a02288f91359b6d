// Sorts the seen cells front to back: stable, so equals come by index. Bound: 4 passes over 8 bytes per cell.
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "trainer/cuda/cub_call.h"
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"

namespace froth {

// Numbers of planes and tiles by rank, which become places by sums; 0 behind the last rank.
static __global__ void countByRankKernel(StepArrays arrays) {
  const uint32_t rank = globalThread();
  if (rank >= arrays.foam.shape.cellCount) return;
  const uint32_t cell = arrays.sortedCells[rank];
  const bool isSeen = rank < arrays.counters->seenCells;
  if (isSeen) arrays.seen.rankOf[cell] = rank;
  arrays.planesBegin[rank] = isSeen ? arrays.pairs.offsets[cell + 1] - arrays.pairs.offsets[cell] : 0;
  arrays.entriesBegin[rank] = isSeen ? arrays.tileCounts[cell] : 0;
}

Status rankCells(const StepArrays& arrays, Scratch& scratch, cudaStream_t stream) {
  const int count = static_cast<int>(arrays.foam.shape.cellCount);
  const Status sorted = callCub(scratch, "sort of cells", [&](void* memory, size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(memory, bytes, arrays.powerKeys, arrays.sortedKeys, arrays.cells,
                                           arrays.sortedCells, count, 0, 32, stream);
  });
  if (!sorted) return sorted;
  countByRankKernel<<<blocksFor(arrays.foam.shape.cellCount), kBlock, 0, stream>>>(arrays);
  for (uint32_t* counts : {arrays.planesBegin, arrays.entriesBegin}) {
    const Status summed = callCub(scratch, "sums over cells", [&](void* memory, size_t& bytes) {
      return cub::DeviceScan::ExclusiveSum(memory, bytes, counts, counts, count, stream);
    });
    if (!summed) return summed;
  }
  return checkLaunch("rankCells");
}

}  // namespace froth
