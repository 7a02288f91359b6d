// Some of many points, spread over all of them.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

// All points but those that coincide with another one, in an order of which each beginning is spread: first one point
// of each cube of a coarse grid, then one of each cube of half that side that has none, and so on. Like farthest-point
// sampling, but in O(n log n). Within a cube the seed chooses. Points outside of +-reach are left out. Coincident: in
// the same cube of side reach / 2^20.
std::vector<uint32_t> spreadOrder(const std::vector<glm::dvec3>& points, double reach, uint64_t seed);

}  // namespace froth
