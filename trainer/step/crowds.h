// Crowds: cells that more balls overlap than a picture needs. Children begin with their parents' radii, which the rates
// hardly change, so where cells are split often the pairs per cell grow with their number, and the cost of a ray with
// both. A ball that is smaller, and denser by as much, shows nearly the same: where all balls of a crowd shrink alike,
// the planes between them stay.
#pragma once

#include <cmath>
#include <cstdint>

#include "shaders/foam/activations.h"
#include "trainer/step/trained_foam.h"

namespace froth {

// A surface that is covered evenly has some 13 overlaps per ball.
inline constexpr uint32_t kMostOverlaps = 24;
inline constexpr float kLeastShrink = 0.95f;  // of a radius at a time: steps repair what it changes

// How many balls overlap that of a cell. The rows hold all pairs that do, and some that do not.
FROTH_HD uint32_t countOverlaps(const glm::vec4* balls, const NeighbourRows& rows, uint32_t cell) {
  const glm::vec4 own = balls[cell];
  uint32_t count = 0;
  for (uint32_t e = rows.offsets[cell]; e < rows.offsets[cell + 1]; ++e) {
    const glm::vec4 other = balls[rows.neighbours[e]];
    const glm::vec3 difference = glm::vec3(other) - glm::vec3(own);
    const float reach = own.w + other.w;
    count += glm::dot(difference, difference) < reach * reach;
  }
  return count;
}

// By what its radius is multiplied, towards as many as there should be: overlaps on a surface grow with r^2.
FROTH_HD float shrinkOf(uint32_t overlaps) {
  if (overlaps <= kMostOverlaps) return 1;
  const float wanted = std::sqrt(float(kMostOverlaps) / float(overlaps));
  return wanted > kLeastShrink ? wanted : kLeastShrink;
}

// What is activated as 0 stays: no raw value is its inverse.
FROTH_HD void scaleActivated(float& raw, float factor) {
  const float scaled = factor * foam::softplus(raw);
  if (scaled > 0) raw = foam::softplusInverse(scaled);
}

// A ray through the centre keeps its optical depth. values: raw.
FROTH_HD void shrinkCell(const ParameterRows<float>& values, const FoamShape& shape, uint32_t cell, float factor) {
  if (factor == 1) return;
  scaleActivated(*values.row(Parameter::kRadii, shape, cell), factor);
  scaleActivated(*values.row(Parameter::kDensity, shape, cell), 1 / factor);
}

}  // namespace froth
