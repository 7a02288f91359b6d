// How far cells may move and grow before their Cech pairs are found again (trainer/cpu/skin_pairs.h).
#pragma once

#include <cmath>

#include <glm/glm.hpp>

#include "trainer/step/host_device.h"

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

}  // namespace froth
