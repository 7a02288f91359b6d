#include "runtime/render/part_order.h"

#include <algorithm>
#include <bit>

#include "runtime/render/camera_rays.h"

namespace froth {
namespace {

// Of their extent: boxes that touch count as apart, however their places are rounded.
constexpr double kTouching = 1e-9;

// Which of two boxes may be drawn first.
struct Sides {
  bool isFirst = false, isSecond = false;
};

struct Interval {
  double low, high;
};

Interval along(const PlacedBox& box, const glm::dvec3& axis) {
  const double middle = glm::dot(box.centre, axis), reach = box.reachAlong(axis);
  return {middle - reach, middle + reach};
}

// ahead: how fast parallel rays go up the axis; 0: rays leave the eye, at 0.
void testAxis(const PlacedBox& a, const PlacedBox& b, const glm::dvec3& axis, double ahead, Sides& sides) {
  const Interval first = along(a, axis), second = along(b, axis);
  const double touching = kTouching * (first.high - first.low + second.high - second.low);
  const bool isBelow = first.high <= second.low + touching, isAbove = second.high <= first.low + touching;
  // Whether rays that cross a plane go up, or down: from the eye's side.
  const auto goesUp = [&](double plane) { return ahead != 0 ? ahead > 0 : plane >= 0; };
  const auto goesDown = [&](double plane) { return ahead != 0 ? ahead < 0 : plane <= 0; };
  if (isBelow) {
    sides.isFirst = sides.isFirst || goesUp(second.low);
    sides.isSecond = sides.isSecond || goesDown(first.high);
  }
  if (isAbove) {
    sides.isSecond = sides.isSecond || goesUp(first.low);
    sides.isFirst = sides.isFirst || goesDown(second.high);
  }
}

// Neither: they meet. Both: no ray meets both.
Sides sidesOf(const PlacedBox& a, const PlacedBox& b, const std::optional<glm::dvec3>& direction) {
  constexpr double kParallel = 1e-9;
  Sides sides;
  const auto test = [&](const glm::dvec3& axis) {
    testAxis(a, b, axis, direction ? glm::dot(*direction, axis) : 0, sides);
  };
  for (int i = 0; i < 3; ++i) {
    test(a.axes[i]);
    test(b.axes[i]);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 across = glm::cross(a.axes[i], b.axes[k]);
      if (glm::length(across) > kParallel) test(glm::normalize(across));
    }
  }
  return sides;
}

// Bits of boxes, by box.
using Masks = std::array<uint32_t, gpu::kMostInstances>;

// Takes the first box behind which none that is left must come. Where each is behind another, the first of all, which
// then overlaps those.
uint32_t takeNext(uint32_t left, const Masks& before, Masks& overlaps) {
  for (uint32_t rest = left; rest != 0; rest &= rest - 1) {
    const auto box = static_cast<uint32_t>(std::countr_zero(rest));
    if ((before[box] & left) == 0) return box;
  }
  const auto box = static_cast<uint32_t>(std::countr_zero(left));
  for (uint32_t rest = before[box] & left; rest != 0; rest &= rest - 1) {
    const auto other = static_cast<uint32_t>(std::countr_zero(rest));
    overlaps[box] |= 1u << other;
    overlaps[other] |= 1u << box;
  }
  return box;
}

}  // namespace

PartOrder orderBoxes(std::span<const PlacedBox> boxes, const std::optional<glm::dvec3>& direction) {
  Masks before{}, overlaps{};
  for (uint32_t a = 0; a < boxes.size(); ++a) {
    for (uint32_t b = a + 1; b < boxes.size(); ++b) {
      const Sides sides = sidesOf(boxes[a], boxes[b], direction);
      if (sides.isFirst && !sides.isSecond) before[b] |= 1u << a;
      if (sides.isSecond && !sides.isFirst) before[a] |= 1u << b;
      if (sides.isFirst || sides.isSecond) continue;
      overlaps[a] |= 1u << b;
      overlaps[b] |= 1u << a;
    }
  }
  PartOrder order;
  uint32_t left = (1u << boxes.size()) - 1;
  for (uint32_t place = 0; place < boxes.size(); ++place) {
    const uint32_t box = takeNext(left, before, overlaps);
    left &= ~(1u << box);
    order.boxes[place] = box;
  }
  for (uint32_t place = 0; place < boxes.size(); ++place) {
    for (uint32_t other = 0; other < boxes.size(); ++other) {
      order.overlaps[place] |= (overlaps[order.boxes[place]] >> order.boxes[other] & 1) << other;
    }
  }
  return order;
}

PartOrder orderParts(const FrothCamera& camera, std::span<const PlacedBox> boxes) {
  if (boxes.size() < 2) return {};
  std::optional<glm::dvec3> direction;
  if (lensClassOf(camera) == gpu::kLensClassOrthographic) {
    direction = computeCameraRays(camera, RenderInstance{}).forward;
  }
  return orderBoxes(boxes, direction);
}

}  // namespace froth
