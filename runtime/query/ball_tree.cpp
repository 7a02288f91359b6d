#include "runtime/query/ball_tree.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace froth {
namespace {

// Of the greatest coordinate at hand: four times what the rounding of boxes, points, differences and products loses.
constexpr float kSlack = 0x1p-20f;

float slackOf(const glm::vec3& point, const BallBox& bounds) {
  const glm::vec3 most = glm::max(glm::abs(point), glm::max(glm::abs(bounds.low), glm::abs(bounds.high)));
  return kSlack * (std::max({most.x, most.y, most.z}) + bounds.radius);
}

// Rounded to float, what comes out is no less, or no more.
double above(double value) { return value + 0x1p-22 * std::abs(value); }
double below(double value) { return value - 0x1p-22 * std::abs(value); }

}  // namespace

BoxTree makeBallTree(std::span<const glm::vec4> balls) {
  std::vector<BallBox> boxes((balls.size() + kBallsPerBox - 1) / kBallsPerBox);
  for (size_t i = 0; i < balls.size(); ++i) {
    boxes[i / kBallsPerBox].add({glm::vec3(balls[i]), glm::vec3(balls[i]), balls[i].w});
  }
  return BoxTree(boxes);
}

RayBounds::RayBounds(const glm::dvec3& origin, const glm::dvec3& direction, double from, const BallBox& bounds)
    : from_(static_cast<float>(below(from))) {
  constexpr float kTiny = 1e-30f;  // a direction of 0 gets a huge inverse: 0 * infinity would be NaN
  const glm::vec3 rounded(origin);
  const float slack = slackOf(rounded, bounds);
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = static_cast<float>(direction[axis]);
    inverse_[axis] = 1 / (std::abs(along) > kTiny ? along : kTiny);
    isForward_[axis] = inverse_[axis] > 0;
    nearOrigin_[axis] = isForward_[axis] ? rounded[axis] + slack : rounded[axis] - slack;
    farOrigin_[axis] = isForward_[axis] ? rounded[axis] - slack : rounded[axis] + slack;
  }
}

void RayBounds::measure(const BoxTree::Node& node, float (&bounds)[BoxTree::kWidth]) const {
  float enter[BoxTree::kWidth], leave[BoxTree::kWidth];
  std::fill(std::begin(enter), std::end(enter), from_);
  std::fill(std::begin(leave), std::end(leave), HUGE_VALF);
  for (int axis = 0; axis < 3; ++axis) {
    const float* nearSide = isForward_[axis] ? node.low[axis] : node.high[axis];
    const float* farSide = isForward_[axis] ? node.high[axis] : node.low[axis];
    const float nearOrigin = nearOrigin_[axis], farOrigin = farOrigin_[axis], inverse = inverse_[axis];
    const float width = std::abs(inverse);
    for (uint32_t i = 0; i < BoxTree::kWidth; ++i) {
      enter[i] = std::max(enter[i], (nearSide[i] - nearOrigin) * inverse - node.radius[i] * width);
      leave[i] = std::min(leave[i], (farSide[i] - farOrigin) * inverse + node.radius[i] * width);
    }
  }
  for (uint32_t i = 0; i < BoxTree::kWidth; ++i) bounds[i] = leave[i] < enter[i] ? HUGE_VALF : enter[i];
}

float RayBounds::limitOf(double t) { return static_cast<float>(std::min(above(t), double{FLT_MAX})); }

}  // namespace froth
