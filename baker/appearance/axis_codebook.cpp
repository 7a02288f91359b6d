#include "baker/appearance/axis_codebook.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "format/quantization.h"

namespace froth {

glm::vec3 warpAxis(const glm::vec3& axis) { return axis / std::sqrt(1 + glm::length(axis)); }

glm::vec3 unwarpAxis(const glm::vec3& warped) {
  const float squared = glm::dot(warped, warped);
  if (!(squared > 0)) return glm::vec3(0);
  const float temperature = (squared + std::sqrt(squared * squared + 4 * squared)) / 2;
  return warped * std::sqrt(1 + temperature);
}

glm::vec3 snapAxis(const glm::vec3& axis, float step) {
  return {snapToStep(axis.x, step), snapToStep(axis.y, step), snapToStep(axis.z, step)};
}

AxisCodebook::AxisCodebook(std::vector<glm::vec3> entries)
    : entries_(std::move(entries)), warped_(entries_.size()), order_(entries_.size()) {
  std::transform(entries_.begin(), entries_.end(), warped_.begin(), warpAxis);
  std::iota(order_.begin(), order_.end(), 0u);
  build(0, static_cast<uint32_t>(order_.size()), 0);
}

void AxisCodebook::build(uint32_t begin, uint32_t end, uint32_t depth) {
  if (end - begin < 2) return;
  const uint32_t middle = begin + (end - begin) / 2;
  const int axis = depth % 3;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](uint32_t a, uint32_t b) {
    return std::pair(warped_[a][axis], a) < std::pair(warped_[b][axis], b);
  });
  build(begin, middle, depth + 1);
  build(middle + 1, end, depth + 1);
}

void AxisCodebook::search(uint32_t begin, uint32_t end, uint32_t depth, const glm::vec3& target, Best& best) const {
  if (begin == end) return;
  const uint32_t middle = begin + (end - begin) / 2, index = order_[middle];
  const glm::vec3 difference = warped_[index] - target;
  const float distance = glm::dot(difference, difference);
  if (distance < best.distance || (distance == best.distance && index < best.index)) best = {distance, index};
  const float toPlane = target[depth % 3] - warped_[index][depth % 3];
  const bool isBelow = toPlane < 0;
  if (isBelow) search(begin, middle, depth + 1, target, best);
  if (!isBelow) search(middle + 1, end, depth + 1, target, best);
  if (toPlane * toPlane > best.distance) return;
  if (isBelow) search(middle + 1, end, depth + 1, target, best);
  if (!isBelow) search(begin, middle, depth + 1, target, best);
}

uint32_t AxisCodebook::findNearest(const glm::vec3& axis) const {
  Best best{std::numeric_limits<float>::infinity(), 0};
  search(0, static_cast<uint32_t>(order_.size()), 0, warpAxis(axis), best);
  return best.index;
}

}  // namespace froth
