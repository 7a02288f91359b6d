// Sites along a space-filling curve.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

// Cells along a Morton curve of 21 bits per axis over the bounding box; ties by index. order[k] = cell at
// place k.
std::vector<uint32_t> mortonOrder(std::span<const glm::vec3> sites);

}  // namespace froth
