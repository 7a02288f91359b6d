// Where a view stands, and which way it looks.
#pragma once

#include <cstddef>

#include <glm/glm.hpp>

#include "reference/camera/camera.h"

namespace froth {

// Stands at `eye` and looks along `forward` [unit]; `up`, any vector that is not along it, points up in the image.
inline void setPose(View& view, const glm::dvec3& eye, const glm::dvec3& forward, const glm::dvec3& up) {
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
  const glm::dvec3 columns[] = {right, glm::cross(forward, right), forward, eye};
  for (size_t row = 0; row < 3; ++row) {
    for (size_t column = 0; column < 4; ++column) {
      view.worldFromCamera[4 * row + column] = columns[column][static_cast<int>(row)];
    }
  }
}

}  // namespace froth
