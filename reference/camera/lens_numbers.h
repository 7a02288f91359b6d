// A lens's coefficients as shaders/foam/lens.h takes them.
#pragma once

#include <glm/glm.hpp>

#include "reference/camera/camera.h"
#include "shaders/foam/lens.h"

namespace froth {

static_assert(static_cast<int>(LensKind::kFisheye) == foam::kLensFisheye &&
              static_cast<int>(LensKind::kKannalaBrandt) == foam::kLensKannalaBrandt &&
              static_cast<int>(LensKind::kRadialTangential) == foam::kLensRadialTangential &&
              static_cast<int>(LensKind::kEquirectangular) == foam::kLensEquirectangular &&
              static_cast<int>(LensKind::kOrthographic) == foam::kLensOrthographic &&
              static_cast<int>(LensKind::kRayMap) == foam::kLensRayMap);

struct LensNumbers {
  int kind;
  glm::dvec4 first{0}, second{0};
  double range;

  explicit LensNumbers(const Lens& lens) : kind(static_cast<int>(lens.kind)) {
    for (size_t i = 0; i < lens.distortion.size(); ++i) {
      (i < 4 ? first : second)[static_cast<int>(i % 4)] = lens.distortion[i];
    }
    range = foam::lensRange(kind, first, second);
  }
};

}  // namespace froth
