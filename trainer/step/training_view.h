// A camera as steps see it, in the normalised scene.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "trainer/step/host_device.h"

namespace froth {

template <class Real>
struct TrainingView {
  uint32_t width = 0, height = 0;  // [pixels]
  Real fx = 0, fy = 0, cx = 0, cy = 0;
  glm::vec<3, Real> eye{0};
  glm::mat<3, 3, Real> worldFromCamera{1};  // columns: right, down, forward
  Real nearRatio = 0, nearDepth = 0;        // docs/FOAM.md "Near cells"; 0: off
  // [pixels * 3] unit directions in the camera's axes, for lenses that are no pinholes; 0 0 0: the pixel has no ray.
  // Null: a pinhole, by fx, fy, cx, cy.
  const float* directions = nullptr;
};

// The unit direction of a pixel, in world axes; 0: it has no ray.
template <class Real>
FROTH_HD glm::vec<3, Real> directionOfPixel(const TrainingView<Real>& view, uint32_t x, uint32_t y) {
  if (view.directions) {
    const float* direction = view.directions + 3 * (size_t{y} * view.width + x);
    return view.worldFromCamera * glm::vec<3, Real>(direction[0], direction[1], direction[2]);
  }
  const glm::vec<3, Real> direction((Real(x) + Real(0.5) - view.cx) / view.fx,
                                    (Real(y) + Real(0.5) - view.cy) / view.fy, Real(1));
  return view.worldFromCamera * (direction / std::sqrt(glm::dot(direction, direction)));
}

}  // namespace froth
