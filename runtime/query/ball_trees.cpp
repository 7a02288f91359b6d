#include "runtime/query/ball_trees.h"

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

BoxTree makeTree(std::span<const glm::vec4> siteRadius) {
  std::vector<BallBox> boxes((siteRadius.size() + kBallsPerBox - 1) / kBallsPerBox);
  for (size_t i = 0; i < siteRadius.size(); ++i) {
    boxes[i / kBallsPerBox].add({glm::vec3(siteRadius[i]), glm::vec3(siteRadius[i]), siteRadius[i].w});
  }
  return BoxTree(boxes);
}

}  // namespace

BallTrees makeBallTrees(std::span<const glm::vec4> siteRadius, uint32_t cellCount, uint32_t liveCount) {
  return {makeTree(siteRadius.first(liveCount)), makeTree(siteRadius.subspan(liveCount, cellCount - liveCount))};
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

PowerBounds::PowerBounds(const glm::dvec3& point, const BallBox& bounds)
    : point_{static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)},
      slack_(slackOf(glm::vec3(point), bounds)) {}

void PowerBounds::measure(const BoxTree::Node& node, float (&bounds)[BoxTree::kWidth]) const {
  float squares[BoxTree::kWidth] = {};
  for (int axis = 0; axis < 3; ++axis) {
    const float point = point_[axis];
    for (uint32_t i = 0; i < BoxTree::kWidth; ++i) {
      const float outside = std::max(std::max(node.low[axis][i] - point, point - node.high[axis][i]) - slack_, 0.0f);
      squares[i] += outside * outside;
    }
  }
  for (uint32_t i = 0; i < BoxTree::kWidth; ++i) {
    bounds[i] = (1 - kSlack) * squares[i] - (1 + kSlack) * node.radius[i] * node.radius[i];
  }
}

float PowerBounds::limitOf(double power) { return static_cast<float>(above(power)); }

}  // namespace froth
