// The tiles that see a ball: a warp looks at those of its balls together, one ball after the other, for a ball near the
// eye has thousands.
#pragma once

#include "trainer/cuda/launch.h"
#include "trainer/step/tiles.h"

namespace froth {

// Balls of a warp, in its first lanes: few, so that there are enough warps for the GPU.
inline constexpr uint32_t kBallsOfWarp = 8;

// Which of all balls is the lane's; UINT32_MAX: none.
__device__ inline uint32_t ballOfThread() {
  return laneOfWarp() < kBallsOfWarp ? globalThread() / kWarp * kBallsOfWarp + laneOfWarp() : UINT32_MAX;
}
inline uint32_t blocksForBalls(size_t balls) {
  return blocksFor((balls + kBallsOfWarp - 1) / kBallsOfWarp * kWarp, kSmallBlock);
}

struct BallTiles {
  glm::vec3 centre{0};  // relative to the eye
  float radius = 0;     // foam::guardedRadius
  TileRange range{0, 0, 0, 0};
};

__device__ inline BallTiles tilesToTest(const TrainingView<float>& view, const glm::vec4& ball) {
  const glm::vec3 centre = glm::vec3(ball) - view.eye;
  return {centre, foam::guardedRadius(centre, ball.w), tilesOfBall(view, centre, ball.w)};
}

__device__ inline BallTiles ballOfLane(const BallTiles& own, int lane) {
  BallTiles ball;
  for (int c = 0; c < 3; ++c) ball.centre[c] = __shfl_sync(kAllLanes, own.centre[c], lane);
  ball.radius = __shfl_sync(kAllLanes, own.radius, lane);
  ball.range = {__shfl_sync(kAllLanes, own.range.beginX, lane), __shfl_sync(kAllLanes, own.range.endX, lane),
                __shfl_sync(kAllLanes, own.range.beginY, lane), __shfl_sync(kAllLanes, own.range.endY, lane)};
  return ball;
}

__device__ inline uint32_t tileCountOf(const TileRange& range) {
  if (range.endX <= range.beginX || range.endY <= range.beginY) return 0;
  return (range.endX - range.beginX) * (range.endY - range.beginY);
}

// Tiles lie in groups, one tile per lane. A ball with many tiles looks at the groups' cones first.
inline constexpr uint32_t kGroupWidth = 8, kGroupHeight = 4, kManyTiles = 4 * kWarp;
static_assert(kGroupWidth * kGroupHeight == kWarp);

FROTH_HD uint32_t groupsAlong(uint32_t tiles, uint32_t size) { return (tiles + size - 1) / size; }
FROTH_HD uint32_t groupCountOf(uint32_t tilesX, uint32_t tilesY) {
  return groupsAlong(tilesX, kGroupWidth) * groupsAlong(tilesY, kGroupHeight);
}

// The tile of a group that a lane has; it may lie beyond the image.
__device__ inline glm::uvec2 tileOfLane(uint32_t group, uint32_t groupsX) {
  return {group % groupsX * kGroupWidth + laneOfWarp() % kGroupWidth,
          group / groupsX * kGroupHeight + laneOfWarp() / kGroupWidth};
}

template <class Visit>
__device__ void visitFewTiles(const BallTiles& ball, int lane, const StepArrays& arrays, uint32_t tilesX,
                              const Visit& visit) {
  const uint32_t count = tileCountOf(ball.range), width = ball.range.endX - ball.range.beginX;
  for (uint32_t first = 0; first < count; first += kWarp) {
    const uint32_t i = first + laneOfWarp();
    const uint32_t tile = (ball.range.beginY + i / width) * tilesX + ball.range.beginX + i % width;
    visit(lane, tile, i < count && foam::coneMeetsBall(arrays.tileCones[tile], ball.centre, ball.radius));
  }
}

template <class Visit>
__device__ void visitManyTiles(const BallTiles& ball, int lane, const StepArrays& arrays, uint32_t tilesX,
                               const Visit& visit) {
  const uint32_t groupsX = groupsAlong(tilesX, kGroupWidth);
  const uint32_t beginX = ball.range.beginX / kGroupWidth, beginY = ball.range.beginY / kGroupHeight;
  const uint32_t width = groupsAlong(ball.range.endX, kGroupWidth) - beginX;
  const uint32_t count = width * (groupsAlong(ball.range.endY, kGroupHeight) - beginY);
  for (uint32_t first = 0; first < count; first += kWarp) {
    const uint32_t i = first + laneOfWarp();
    const uint32_t group = (beginY + i / width) * groupsX + beginX + i % width;
    const bool meets = i < count && foam::coneMeetsBall(arrays.groupCones[group], ball.centre, ball.radius);
    for (uint32_t meeting = __ballot_sync(kAllLanes, meets); meeting != 0; meeting &= meeting - 1) {
      const uint32_t met = __shfl_sync(kAllLanes, group, __ffs(static_cast<int>(meeting)) - 1);
      const glm::uvec2 at = tileOfLane(met, groupsX);
      const TileRange& range = ball.range;
      const bool isIn = at.x >= range.beginX && at.x < range.endX && at.y >= range.beginY && at.y < range.endY;
      const uint32_t tile = at.y * tilesX + at.x;
      visit(lane, tile, isIn && foam::coneMeetsBall(arrays.tileCones[tile], ball.centre, ball.radius));
    }
  }
}

// All lanes call it. visit(lane, tile, isSeen): for each lane's ball, by all lanes, for each tile of its range at most,
// each once; `tile` differs by lane.
template <class Visit>
__device__ void visitTiles(const BallTiles& own, const StepArrays& arrays, uint32_t tilesX, const Visit& visit) {
  for (uint32_t lanes = __ballot_sync(kAllLanes, tileCountOf(own.range) > 0); lanes != 0; lanes &= lanes - 1) {
    const int lane = __ffs(static_cast<int>(lanes)) - 1;
    const BallTiles ball = ballOfLane(own, lane);
    if (tileCountOf(ball.range) < kManyTiles) {
      visitFewTiles(ball, lane, arrays, tilesX, visit);
    } else {
      visitManyTiles(ball, lane, arrays, tilesX, visit);
    }
  }
}

}  // namespace froth
