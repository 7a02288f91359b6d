#include "baker/cells/mark_cells.h"

#include <algorithm>

namespace froth {
namespace {

// A cell is dead if its opacity 1 - exp(-2 r sigma) along its longest chord is below this. Such a cell adds
// less than 2^-24 of its colour to a ray and leaves a float transmittance within one rounding: a ray must
// cross 128 of them before a 16-bit channel, of half-step 2^-17, can change.
constexpr double kDeadOpticalDepth = 0x1p-24;

}  // namespace

CellState stateOf(const BakeCells& cells, uint32_t cell, bool isHidden, bool isEmpty) {
  if (isHidden) return CellState::kHidden;
  if (cells.sources[cell] == kNoSource) return CellState::kSteiner;
  if (isEmpty) return CellState::kEmpty;
  if (cell < cells.inputCount() && cells.isUnseen[cell]) return CellState::kUnseen;
  if (2.0 * cells.radii[cell] * cells.densities[cell] < kDeadOpticalDepth) return CellState::kDead;
  return CellState::kLive;
}

std::vector<CellState> markCells(const BakeCells& cells, const RegularTriangulation& triangulation,
                                 const AlphaComplex& alpha, bool hasWalkGraph) {
  std::vector<CellState> states(cells.count());
  for (uint32_t cell = 0; cell < cells.count(); ++cell) {
    states[cell] = stateOf(cells, cell, triangulation.isHidden[cell], alpha.isEmpty[cell]);
  }
  if (hasWalkGraph) return states;

  std::vector<uint8_t> isNeeded(cells.count(), 0);
  for (uint32_t cell = 0; cell < cells.count(); ++cell) {
    if (states[cell] != CellState::kLive) continue;
    isNeeded[cell] = 1;
    for (uint32_t entry = alpha.graph.offsets[cell]; entry < alpha.graph.offsets[cell + 1]; ++entry) {
      isNeeded[alpha.graph.neighbours[entry]] = 1;
    }
  }
  for (uint32_t cell = 0; cell < cells.count(); ++cell) {
    if (!isNeeded[cell] && isInAsset(states[cell])) states[cell] = CellState::kUnneeded;
  }
  return states;
}

BakeStatistics countCells(const BakeCells& cells, const std::vector<CellState>& states,
                          const RegularTriangulation& triangulation, const AlphaComplex& alpha) {
  const auto inputEnd = states.begin() + cells.inputCount();
  const auto count = [&](CellState state) {
    return static_cast<uint64_t>(std::count(states.begin(), inputEnd, state));
  };
  BakeStatistics statistics;
  statistics.hiddenDropped = count(CellState::kHidden);
  statistics.duplicatesMerged = triangulation.duplicates;
  statistics.emptyCells = count(CellState::kEmpty);
  statistics.deadCells = count(CellState::kDead);
  statistics.steinerCells = static_cast<uint64_t>(std::count(inputEnd, states.end(), CellState::kSteiner));
  statistics.walkPairs = triangulation.graph.neighbours.size() / 2;
  statistics.alphaPairs = alpha.graph.neighbours.size() / 2;
  return statistics;
}

}  // namespace froth
