// How far cells may move and grow before their Cech pairs are found again (trainer/cpu/skin_pairs.h), and which of
// those overlap.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

#include "trainer/step/host_device.h"
#include "trainer/step/trained_foam.h"

namespace froth {

// What a ball is enlarged by when pairs are found [scene units]; leastSkin: of small balls.
FROTH_HD float skinOf(float radius, float leastSkin) {
  const float ofRadius = 0.05f * radius;
  return ofRadius > leastSkin ? ofRadius : leastSkin;
}

// By how much it may then change: a millionth less, for the rounding of sums.
FROTH_HD float slackOf(float skin) { return (1 - 1e-6f) * skin; }

// found: the ball when the pairs were found.
template <class Real>
FROTH_HD bool isWithinSlack(const glm::vec<4, Real>& ball, const glm::vec4& found, float slack) {
  const glm::vec<4, Real> change = ball - glm::vec<4, Real>(found);
  return glm::length(glm::vec<3, Real>(change)) + std::abs(change.w) <= Real(slack);
}

// How many other balls overlap the cell's, of its row of pairs.
template <class Real>
FROTH_HD uint32_t countOverlaps(const glm::vec<4, Real>* balls, const NeighbourRows& rows, uint32_t cell) {
  uint32_t count = 0;
  for (uint32_t e = rows.offsets[cell]; e < rows.offsets[cell + 1]; ++e) {
    const glm::vec<4, Real> other = balls[rows.neighbours[e]];
    const glm::vec<3, Real> difference = glm::vec<3, Real>(other) - glm::vec<3, Real>(balls[cell]);
    const Real reach = balls[cell].w + other.w;
    count += glm::dot(difference, difference) < reach * reach;
  }
  return count;
}

}  // namespace froth
