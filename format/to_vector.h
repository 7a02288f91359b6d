// Vectors as structs without GLM hold them, as glm::dvec3.
#pragma once

#include <array>

#include <glm/glm.hpp>

namespace froth {

inline glm::dvec3 toVector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
inline glm::dvec3 toVector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

}  // namespace froth
