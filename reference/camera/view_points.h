// Where places of the scene are seen in a view, through any lens with a formula.
#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "reference/camera/camera.h"
#include "reference/camera/lens_numbers.h"

namespace froth {

// The other way of ViewRays.
class ViewPoints {
 public:
  // Keeps a reference to the view. A ray map and an orthographic lens see no point here.
  explicit ViewPoints(const View& view);

  // The point of the image [pixels] that shows a place; none outside of the image, behind a lens that looks forward,
  // and beyond the range of a distortion.
  std::optional<glm::dvec2> of(const glm::dvec3& place) const;

 private:
  const View& view_;
  LensNumbers lens_;
};

}  // namespace froth
