// The tiles that see a ball: a warp looks at those of its 32 balls together, for a ball near the eye has thousands.
#pragma once

#include "trainer/cuda/launch.h"
#include "trainer/step/tiles.h"

namespace froth {

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

// All lanes call it. visit(lane, tile, isSeen): for each lane's ball, by all lanes, for each tile of its range at most;
// `tile` differs by lane.
template <class Visit>
__device__ void visitTiles(const BallTiles& own, const glm::vec4* cones, uint32_t tilesX, const Visit& visit) {
  for (uint32_t lanes = __ballot_sync(kAllLanes, tileCountOf(own.range) > 0); lanes != 0; lanes &= lanes - 1) {
    const int lane = __ffs(static_cast<int>(lanes)) - 1;
    const BallTiles ball = ballOfLane(own, lane);
    const uint32_t count = tileCountOf(ball.range), width = ball.range.endX - ball.range.beginX;
    for (uint32_t first = 0; first < count; first += kWarp) {
      const uint32_t i = first + laneOfWarp();
      const uint32_t tile = (ball.range.beginY + i / width) * tilesX + ball.range.beginX + i % width;
      visit(lane, tile, i < count && foam::coneMeetsBall(cones[tile], ball.centre, ball.radius));
    }
  }
}

}  // namespace froth
