// Which cells of a group become one in its coarse form, and what they look like then. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/lod/fine_form.h"
#include "baker/lod/level_source.h"
#include "baker/lod/merge_cells.h"
#include "foam/foam.h"

namespace froth {

// Cells of a fine form with faces: live ones, and those that only cut live ones.
struct FacedCells {
  std::vector<uint32_t> cells;        // indices of the fine form
  Foam faces;                         // on the lattices; without density where not live
  std::vector<double> contributions;  // [cells] or empty
};

FacedCells gatherFaced(const LevelSource& source, const FineForm& fine);

// Between rounds of merges.
struct MergedFoam {
  Foam cells;
  std::vector<double> contributions;           // [cells] or empty
  std::vector<uint8_t> isLocked;               // [cells]
  std::vector<std::vector<uint32_t>> members;  // [cells] of what the rounds began with
};

// Cells in no pair stay, in order; the merged ones come behind them, and are not locked. Takes the members of `before`.
MergedFoam mergeRound(MergedFoam& before, std::span<const CellPair> pairs, std::span<const glm::vec3> eyes);

struct MergePlan {
  std::vector<std::vector<uint32_t>> clusters;  // cells of the scene, two or more, that become one
  Foam merged;                                  // [clusters]
  std::vector<double> contributions;            // [clusters] or empty
};

// Half of the live cells of the form go, or as many as there are that may: locked cells merge with none, nor do those
// that `staysApart` [cells of the scene] marks. The same plan on any number of threads.
MergePlan planMerges(const LevelSource& source, const FineForm& fine, std::span<const uint8_t> staysApart);

}  // namespace froth
