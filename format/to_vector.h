// Vectors of structs without GLM, as ours.
#pragma once

#include <array>

#include <glm/glm.hpp>

namespace froth {

inline glm::dvec3 toVector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
inline glm::dvec3 toVector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

}  // namespace froth
