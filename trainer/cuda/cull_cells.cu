// Near tests, the tiles that see each ball, and the key that orders what is seen. Bound: 16 bytes read and 16 written
// per cell, and some 30 flops per ball and tile of its box, or of the groups of tiles that it meets where they are
// many.
#include "trainer/cuda/ball_tiles.h"
#include "trainer/cuda/passes.h"

namespace froth {
namespace {

__global__ void findConesKernel(StepArrays arrays, TrainingView<float> view) {
  const uint32_t tile = globalThread(), tilesX = tilesAlong(view.width);
  if (tile < tilesX * tilesAlong(view.height)) {
    arrays.tileCones[tile] = coneOfTile(view, tile % tilesX, tile / tilesX);
  }
}

// Around the cones of a group's tiles, by a warp.
__global__ void findGroupConesKernel(StepArrays arrays, uint32_t tilesX, uint32_t tilesY) {
  const uint32_t group = globalThread() / kWarp, groupsX = groupsAlong(tilesX, kGroupWidth);
  if (group >= groupCountOf(tilesX, tilesY)) return;
  const glm::uvec2 tile = tileOfLane(group, groupsX);
  const bool isTile = tile.x < tilesX && tile.y < tilesY;
  const glm::vec4 cone = isTile ? arrays.tileCones[tile.y * tilesX + tile.x] : glm::vec4(0, 0, 1, foam::kConeOfNone);
  const glm::vec3 sum = sumOfLanes(cone.w >= 0 ? glm::vec3(cone) : glm::vec3(0), kWarp);
  const float length = sqrtf(glm::dot(sum, sum));
  const glm::vec3 axis = length > 0 ? sum / length : glm::vec3(0, 0, 1);
  const float least = length > 0 ? 0 : float(foam::kConeOfAll);
  const float sine = largestOfLanes(fmaxf(least, foam::sineToHold(axis, cone)), kWarp);
  if (laneOfWarp() == 0) arrays.groupCones[group] = foam::guardedCone(axis, sine);
}

// Unsigned numbers in the order of floats that are finite.
__device__ uint32_t orderedBits(float value) {
  const uint32_t bits = __float_as_uint(value + 0.0f);  // -0 becomes 0
  return bits ^ (bits >> 31 ? 0xffffffffu : 0x80000000u);
}

__global__ void cullCellsKernel(StepArrays arrays, TrainingView<float> view) {
  const uint32_t cell = ballOfThread(), tilesX = tilesAlong(view.width);
  const bool isCell = cell < arrays.foam.shape.cellCount;
  BallTiles tiles;
  float power = 0;
  if (isCell) {
    const glm::vec4 ball = arrays.foam.balls[cell];
    const glm::vec3 centre = glm::vec3(ball) - view.eye;
    power = foam::powerOfOrigin(centre, ball.w);
    const bool isShown = isfinite(power) && ball.w > 0 &&
                         !foam::isNearCell(centre, ball.w, view.worldFromCamera[2], view.nearRatio, view.nearDepth);
    if (isShown) tiles = tilesToTest(view, ball);
  }
  uint32_t tileCount = 0;
  visitTiles(tiles, arrays, tilesX, [&](int lane, uint32_t, bool isSeen) {
    const uint32_t found = __popc(__ballot_sync(kAllLanes, isSeen));
    if (laneOfWarp() == static_cast<uint32_t>(lane)) tileCount += found;
  });
  if (isCell) {
    arrays.powerKeys[cell] = tileCount > 0 ? orderedBits(power) : kUnseenKey;
    arrays.cells[cell] = cell;
    arrays.tileCounts[cell] = tileCount;
    arrays.seen.rankOf[cell] = SeenCells<float>::kNotSeen;
  }
  const uint32_t seen = __popc(__ballot_sync(kAllLanes, tileCount > 0));
  const uint32_t entries = __reduce_add_sync(kAllLanes, tileCount);
  if (laneOfWarp() == 0 && seen > 0) {
    atomicAdd(&arrays.counters->seenCells, seen);
    atomicAdd(&arrays.counters->tileEntries, entries);
  }
}

}  // namespace

Status cullCells(const StepArrays& arrays, const TrainingView<float>& view, cudaStream_t stream) {
  static_assert(offsetof(StepCounters, droppedCount) == 8, "the counters of one view come first");
  cudaMemsetAsync(arrays.counters, 0, offsetof(StepCounters, droppedCount), stream);
  const uint32_t tilesX = tilesAlong(view.width), tilesY = tilesAlong(view.height);
  const auto blocks = [](size_t threads) { return blocksFor(threads, kSmallBlock); };
  findConesKernel<<<blocks(size_t{tilesX} * tilesY), kSmallBlock, 0, stream>>>(arrays, view);
  findGroupConesKernel<<<blocks(size_t{groupCountOf(tilesX, tilesY)} * kWarp), kSmallBlock, 0, stream>>>(arrays, tilesX,
                                                                                                         tilesY);
  cullCellsKernel<<<blocksForBalls(arrays.foam.shape.cellCount), kSmallBlock, 0, stream>>>(arrays, view);
  return checkLaunch("cullCells");
}

}  // namespace froth
