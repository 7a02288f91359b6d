// The rays of a view's pixels, through any lens.
#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "reference/camera/camera.h"
#include "reference/camera/lens_numbers.h"

namespace froth {

inline glm::dvec3 eyeOf(const View& view) {
  return {view.worldFromCamera[3], view.worldFromCamera[7], view.worldFromCamera[11]};
}

// Unit view axis.
inline glm::dvec3 forwardOf(const View& view) {
  const auto& m = view.worldFromCamera;
  return glm::normalize(glm::dvec3(m[2], m[6], m[10]));
}

// Starts at the eye plus `offset`, which is 0 but for an orthographic lens, and perpendicular to the direction there.
struct ViewRay {
  glm::dvec3 offset;     // [scene units] world axes
  glm::dvec3 direction;  // unit length
};

class ViewRays {
 public:
  // Keeps a reference to the view.
  explicit ViewRays(const View& view);

  // Through a point of the image [pixels; the centre of pixel (0, 0) is (0.5, 0.5)]; none where the lens sees nothing.
  // A ray map gives the ray of the pixel that holds the point.
  std::optional<ViewRay> at(double x, double y) const;
  std::optional<ViewRay> ofPixel(uint32_t x, uint32_t y) const { return at(x + 0.5, y + 0.5); }

 private:
  glm::dvec3 toWorld(const glm::dvec3& vector) const;

  const View& view_;
  LensNumbers lens_;
};

}  // namespace froth
