#include "baker/lod/group_balls.h"

#include <limits>

namespace froth {

void addLiveBalls(const BakeCells& cells, const PlannedChunk& chunk, std::vector<GroupBall>& balls) {
  for (uint32_t local = 0; local < chunk.liveCount; ++local) {
    const uint32_t cell = chunk.cells[local];
    balls.push_back({glm::dvec3(cells.sites[cell]), double{cells.radii[cell]}});
  }
}

GroupBall boundBalls(std::span<const GroupBall> balls) {
  if (balls.empty()) return {};
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const GroupBall& ball : balls) {
    low = glm::min(low, ball.centre - ball.radius);
    high = glm::max(high, ball.centre + ball.radius);
  }
  GroupBall bound{0.5 * (low + high), 0};
  for (const GroupBall& ball : balls) {
    bound.radius = glm::max(bound.radius, glm::distance(bound.centre, ball.centre) + ball.radius);
  }
  constexpr double kRounding = 1 + 0x1p-40;  // more than a distance rounds
  bound.radius *= kRounding;
  return bound;
}

}  // namespace froth
