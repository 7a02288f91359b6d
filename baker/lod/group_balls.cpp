#include "baker/lod/group_balls.h"

#include <limits>
#include <utility>

namespace froth {
namespace {

std::pair<glm::dvec3, glm::dvec3> cornersAround(std::span<const GroupBall> balls) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const GroupBall& ball : balls) {
    low = glm::min(low, ball.centre - ball.radius);
    high = glm::max(high, ball.centre + ball.radius);
  }
  return {low, high};
}

}  // namespace

void addLiveBalls(const BakeCells& cells, const PlannedChunk& chunk, std::vector<GroupBall>& balls) {
  for (uint32_t local = 0; local < chunk.liveCount; ++local) {
    const uint32_t cell = chunk.cells[local];
    balls.push_back({glm::dvec3(cells.sites[cell]), double{cells.radii[cell]}});
  }
}

Box boxAroundLive(const BakeCells& cells, const PlannedChunk& chunk) {
  if (chunk.liveCount == 0) return {};
  std::vector<GroupBall> balls;
  addLiveBalls(cells, chunk, balls);
  const auto [low, high] = cornersAround(balls);
  return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

GroupBall boundBalls(std::span<const GroupBall> balls) {
  if (balls.empty()) return {};
  const auto [low, high] = cornersAround(balls);
  GroupBall bound{0.5 * (low + high), 0};
  for (const GroupBall& ball : balls) {
    bound.radius = glm::max(bound.radius, glm::distance(bound.centre, ball.centre) + ball.radius);
  }
  constexpr double kRounding = 1 + 0x1p-40;  // more than a distance rounds
  bound.radius *= kRounding;
  return bound;
}

}  // namespace froth
