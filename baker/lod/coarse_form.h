// The coarse form of a group: half of its cells merged in pairs, its border as it was (docs/STREAMING.md).
#pragma once

#include <cstdint>
#include <vector>

#include "baker/cells/cells.h"
#include "baker/lod/fine_form.h"
#include "baker/lod/merge_plan.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

struct CoarseForm {
  std::vector<uint32_t> kept;                  // cells of the scene that are in both forms
  Foam merged;                                 // new cells
  std::vector<double> contributions;           // [merged cells]
  std::vector<std::vector<uint32_t>> members;  // [merged cells] cells of the scene that each stands for
  std::vector<uint8_t> isEmpty;                // [kept and merged cells] no bounded cell
  // Rows of kept, then merged cells; neighbours are these cells by index, and behind them the ring of the fine form.
  CellRows rows;
  double distance = 0;  // form_distance.h [scene units]

  uint32_t lockedLive = 0, liveCount = 0;  // of the fine form
  uint32_t undone = 0, rounds = 0;         // LevelReport
  bool isWorthwhile = false;               // has clearly fewer live cells than the fine form
};

// A cell with a neighbour outside is kept; no merged cell becomes a neighbour of a cell outside.
//
// It is enough to look at merged cells: what a dropped cell leaves falls to its own neighbours, which lie inside, and a
// pair of neighbours across the border can only come or go where a merged cell reaches the cell outside.
// Merges of the plan that would do so are undone.
Result<CoarseForm> makeCoarseForm(const LevelSource& source, const FineForm& fine, const MergePlan& plan);

}  // namespace froth
