// The list of each tile, front to back: entries are written by rank and sorted by tile, which keeps their order. Bound:
// 2 passes over 8 bytes per entry (up to 65,536 tiles).
#include <cub/device/device_radix_sort.cuh>

#include <bit>

#include "trainer/cuda/ball_tiles.h"
#include "trainer/cuda/cub_call.h"
#include "trainer/cuda/passes.h"

namespace froth {
namespace {

constexpr uint32_t kLongestList = 0xffff;  // longer ones count as that

__global__ void writeEntriesKernel(StepArrays arrays, TrainingView<float> view) {
  const uint32_t rank = ballOfThread(), firstRank = __shfl_sync(kAllLanes, rank, 0);
  const uint32_t seenCount = arrays.counters->seenCells;
  if (firstRank >= seenCount) return;
  BallTiles tiles;
  uint32_t place = 0;
  if (rank < seenCount) {
    tiles = tilesToTest(view, arrays.foam.balls[arrays.sortedCells[rank]]);
    place = arrays.entriesBegin[rank];
  }
  visitTiles(tiles, arrays, tilesAlong(view.width), [&](int lane, uint32_t tile, bool isSeen) {
    const uint32_t seen = __ballot_sync(kAllLanes, isSeen);
    const uint32_t entry = __shfl_sync(kAllLanes, place, lane) + __popc(seen & lanesBefore());
    if (isSeen && entry < arrays.entryCapacity) {
      arrays.entryTiles[entry] = tile;
      arrays.entryRanks[entry] = firstRank + lane;
    }
    if (laneOfWarp() == static_cast<uint32_t>(lane)) place += __popc(seen);
  });
}

// What is left of the capacity goes behind the last tile.
__global__ void fillEntriesKernel(StepArrays arrays, uint32_t tileCount) {
  const uint32_t entry = globalThread();
  if (entry >= arrays.counters->tileEntries && entry < arrays.entryCapacity) arrays.entryTiles[entry] = tileCount;
}

// tilesBegin[tile]: the first entry of that tile or a later one.
__global__ void findTilesKernel(StepArrays arrays, uint32_t tileCount) {
  const uint32_t entry = globalThread();
  if (entry > arrays.entryCapacity) return;
  const uint32_t own = entry < arrays.entryCapacity ? arrays.sortedTiles[entry] : tileCount;
  const uint32_t first = entry > 0 ? arrays.sortedTiles[entry - 1] + 1 : 0;
  for (uint32_t tile = first; tile <= own; ++tile) arrays.tilesBegin[tile] = entry;
}

// Tiles with long lists come first, so that none begins when all others are done.
__global__ void measureTilesKernel(StepArrays arrays, uint32_t tileCount) {
  const uint32_t tile = globalThread();
  if (tile >= tileCount) return;
  const uint32_t length = arrays.tilesBegin[tile + 1] - arrays.tilesBegin[tile];
  arrays.tileLengths[tile] = min(length, kLongestList);
  arrays.tiles[tile] = tile;
}

Status orderTiles(const StepArrays& arrays, uint32_t tileCount, Scratch& scratch, cudaStream_t stream) {
  measureTilesKernel<<<blocksFor(tileCount), kBlock, 0, stream>>>(arrays, tileCount);
  return callCub(scratch, "sort of tiles", [&](void* memory, size_t& bytes) {
    return cub::DeviceRadixSort::SortPairsDescending(memory, bytes, arrays.tileLengths, arrays.sortedTileLengths,
                                                     arrays.tiles, arrays.tileOrder, static_cast<int>(tileCount), 0,
                                                     std::bit_width(kLongestList), stream);
  });
}

}  // namespace

Status binTiles(const StepArrays& arrays, const TrainingView<float>& view, Scratch& scratch, cudaStream_t stream) {
  const uint32_t tileCount = tilesAlong(view.width) * tilesAlong(view.height);
  writeEntriesKernel<<<blocksForBalls(arrays.foam.shape.cellCount), kSmallBlock, 0, stream>>>(arrays, view);
  fillEntriesKernel<<<blocksFor(arrays.entryCapacity), kBlock, 0, stream>>>(arrays, tileCount);
  const Status sorted = callCub(scratch, "sort of tile entries", [&](void* memory, size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(memory, bytes, arrays.entryTiles, arrays.sortedTiles, arrays.entryRanks,
                                           arrays.sortedRanks, static_cast<int>(arrays.entryCapacity), 0,
                                           std::bit_width(tileCount), stream);
  });
  if (!sorted) return sorted;
  findTilesKernel<<<blocksFor(size_t{arrays.entryCapacity} + 1), kBlock, 0, stream>>>(arrays, tileCount);
  if (Status ordered = orderTiles(arrays, tileCount, scratch, stream); !ordered) return ordered;
  return checkLaunch("binTiles");
}

}  // namespace froth
