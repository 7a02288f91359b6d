#include "reference/render/ball_hierarchy.h"

#include <algorithm>

namespace froth {

BallHierarchy::BallHierarchy(std::span<const glm::vec3> sites, std::span<const float> radii,
                             std::vector<uint32_t> cells)
    : cells_(std::move(cells)) {
  if (!cells_.empty()) build(0, static_cast<uint32_t>(cells_.size()), sites, radii);
}

// Halves the cells along the longest side of the box of their sites.
uint32_t BallHierarchy::build(uint32_t begin, uint32_t end, std::span<const glm::vec3> sites,
                              std::span<const float> radii) {
  const uint32_t index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box balls{glm::dvec3(HUGE_VAL), glm::dvec3(-HUGE_VAL)}, centres = balls;
  for (uint32_t i = begin; i < end; ++i) {
    const glm::dvec3 site = sites[cells_[i]];
    const double radius = radii[cells_[i]];
    balls = {glm::min(balls.low, site - radius), glm::max(balls.high, site + radius)};
    centres = {glm::min(centres.low, site), glm::max(centres.high, site)};
  }
  nodes_[index].box = balls;
  if (end - begin <= kLeafSize) {
    nodes_[index].first = begin;
    nodes_[index].count = end - begin;
    return index;
  }
  const glm::dvec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(
      cells_.begin() + begin, cells_.begin() + middle, cells_.begin() + end,
      [&](uint32_t a, uint32_t b) { return std::pair(sites[a][axis], a) < std::pair(sites[b][axis], b); });
  build(begin, middle, sites, radii);
  const uint32_t second = build(middle, end, sites, radii);
  nodes_[index].first = second;
  return index;
}

}  // namespace froth
