// Crowds: cells that more balls overlap than a picture needs. Children begin with their parents' radii, which the rates
// hardly change, so where cells are split often the pairs per cell grow with their number, and the cost of a ray with
// both. A ball that is smaller, and denser by as much, shows nearly the same: where all balls of a crowd shrink alike,
// the planes between them stay.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "trainer/step/trained_foam.h"

namespace froth {

// A surface that is covered evenly has some 13 overlaps per ball.
inline constexpr uint32_t kMostOverlaps = 24;
inline constexpr float kLeastShrink = 0.95f;  // of a radius at a time: steps repair what it changes
// Foams of fewer cells keep their radii. Children lie in a pile at their parent's site, and sites move by a tenth of
// the scene's unit at most until cells change again: balls of few cells are larger than that, so a pile has not spread
// by then, and would leave a gap around it.
inline constexpr uint32_t kFewCells = 8000;

FROTH_HD bool ballsOverlap(const glm::vec4& a, const glm::vec4& b) {
  const glm::vec3 difference = glm::vec3(b) - glm::vec3(a);
  const float reach = a.w + b.w;
  return glm::dot(difference, difference) < reach * reach;
}

// How many balls overlap that of a cell. The rows hold all pairs that do, and some that do not.
FROTH_HD uint32_t countOverlaps(const glm::vec4* balls, const NeighbourRows& rows, uint32_t cell) {
  uint32_t count = 0;
  for (uint32_t e = rows.offsets[cell]; e < rows.offsets[cell + 1]; ++e) {
    count += ballsOverlap(balls[cell], balls[rows.neighbours[e]]);
  }
  return count;
}

// By what a radius is multiplied in a foam of so many cells, towards as many as there should be: overlaps on a surface
// grow with r^2.
FROTH_HD float shrinkOf(size_t cells, uint32_t overlaps) {
  if (overlaps <= kMostOverlaps || cells < kFewCells) return 1;
  const float wanted = std::sqrt(float(kMostOverlaps) / float(overlaps));
  return wanted > kLeastShrink ? wanted : kLeastShrink;
}

}  // namespace froth
