// An instance as queries see it: an asset's foam and where it stands.
#pragma once

#include <glm/glm.hpp>

#include "froth/froth.h"
#include "runtime/query/query_foam.h"

namespace froth {

struct PlacedFoam {
  const QueryFoam* foam = nullptr;
  FrothInstance instance{};
  glm::dvec3 position{0};
  glm::dmat3 rotation{1};  // world from asset, orthonormal
  double scale = 1;

  glm::dvec3 assetFromWorld(const glm::dvec3& point) const {
    return glm::transpose(rotation) * (point - position) / scale;
  }
  glm::dvec3 worldFromAsset(const glm::dvec3& point) const { return position + rotation * (scale * point); }
};

}  // namespace froth
