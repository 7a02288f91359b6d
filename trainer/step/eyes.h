// Where the cameras are, and in which unit lengths count around them.
//
// Rates and the loss of overlaps are meant for cells a few scene units from a camera. What lies far behind them looks
// smaller by its distance: a cell 150 units away would need some 40 steps for what takes one near the cameras. So there
// sites, radii and the loss of overlaps count in a unit that grows with the distance, and densities in one per unit.
// Adam's steps do not depend on the size of gradients, so that factors of rates are all it takes.
#pragma once

#include <limits>

#include <glm/glm.hpp>

#include "trainer/step/host_device.h"

namespace froth {

// A ball around all cameras, in the normalised scene. Without one the unit is that of the scene everywhere.
struct Eyes {
  glm::vec3 centre{0};
  float radius = std::numeric_limits<float>::infinity();
};

// From the cameras: the median distance to what they look at (scene_frame.h). Rates are meant for it.
inline constexpr float kNearDistance = 4;

// [>= 1, in scene units] ball: site, radius.
template <class Real>
FROTH_HD Real unitAt(const Eyes& eyes, const glm::vec<4, Real>& ball) {
  const glm::vec<3, Real> offset = glm::vec<3, Real>(ball) - glm::vec<3, Real>(eyes.centre);
  const Real unit = (glm::length(offset) - Real(eyes.radius)) / Real(kNearDistance);
  return unit > 1 ? unit : Real(1);
}

}  // namespace froth
