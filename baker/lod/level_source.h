// What the groups of a level are made coarser from. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/cells/cells.h"
#include "foam/foam.h"
#include "format/quantization.h"

namespace froth {

struct LevelSource {
  const Foam& input;
  const Foam& merged;  // BakeCells::sources continue into it
  const BakeCells& cells;
  const std::vector<double>& contributions;  // [input cells, merged cells] how much each shows; empty: all alike
  const std::vector<glm::vec3>& eyes;        // from where the foam is seen; may be empty
  const Quantization& lattices;
};

// The listed cells of the scene, none a Steiner cell, with sites, radii and densities on the lattices; without density
// where not live.
Foam gatherSnapped(const LevelSource& source, std::span<const uint32_t> cells, std::span<const uint8_t> isLive);

}  // namespace froth
