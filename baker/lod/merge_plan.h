// Which cells of a group become one in its coarse form, and what they look like then. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/cells/cells.h"
#include "baker/lod/fine_form.h"
#include "foam/foam.h"
#include "format/quantization.h"

namespace froth {

// What groups are made coarser from.
struct LevelSource {
  const Foam& input;
  const Foam& merged;  // BakeCells::sources continue into it
  const BakeCells& cells;
  const std::vector<double>& contributions;  // [input cells, merged cells] how much each shows; empty: all alike
  const std::vector<glm::vec3>& eyes;        // from where the foam is seen; may be empty
  const Quantization& lattices;
};

// Cells of a fine form with faces: live ones, and those that only cut live ones.
struct FacedCells {
  std::vector<uint32_t> cells;        // indices of the fine form
  Foam faces;                         // on the lattices; without density where not live
  std::vector<double> contributions;  // [cells] or empty
};

FacedCells gatherFaced(const LevelSource& source, const FineForm& fine);

struct MergePlan {
  std::vector<std::vector<uint32_t>> clusters;  // cells of the scene, two or more, that become one
  Foam merged;                                  // [clusters]
  std::vector<double> contributions;            // [clusters] or empty
};

// Half of the live cells of the form go, or as many as there are that may: locked cells merge with none, nor do those
// that `staysApart` [cells of the scene] marks. The same plan on any number of threads.
MergePlan planMerges(const LevelSource& source, const FineForm& fine, std::span<const uint8_t> staysApart);

}  // namespace froth
