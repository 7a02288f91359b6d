#include "baker/bake/cull_unseen.h"

#include <algorithm>
#include <vector>

#include "foam/cech_pairs.h"
#include "foam/cell_graph.h"

namespace froth {
namespace {

bool overlapsSeenCell(const CellGraph& overlaps, uint32_t cell, const std::vector<uint8_t>& isUnseen) {
  const auto row = overlaps.neighbours.begin();
  return std::any_of(row + overlaps.offsets[cell], row + overlaps.offsets[cell + 1],
                     [&](uint32_t neighbour) { return !isUnseen[neighbour]; });
}

}  // namespace

uint64_t cullUnseenCells(BakeCells& cells, std::span<const float> contributions, float limit,
                         const Progress& progress) {
  for (uint32_t cell = 0; cell < cells.count(); ++cell) cells.isUnseen[cell] = !(contributions[cell] > limit);
  const uint64_t culled = std::count(cells.isUnseen.begin(), cells.isUnseen.end(), uint8_t{1});
  if (culled == 0) return 0;

  const CellGraph overlaps = findCechPairs(cells.sites, cells.radii, progress);
  if (overlaps.offsets.empty()) return 0;
  std::vector<uint8_t> stays(cells.count());
  for (uint32_t cell = 0; cell < cells.count(); ++cell) {
    stays[cell] = !cells.isUnseen[cell] || overlapsSeenCell(overlaps, cell, cells.isUnseen);
  }
  // An asset has at least one cell.
  if (std::count(stays.begin(), stays.end(), uint8_t{1}) == 0) stays[0] = 1;

  uint32_t place = 0;
  for (uint32_t cell = 0; cell < cells.count(); ++cell) {
    if (!stays[cell]) continue;
    cells.sites[place] = cells.sites[cell];
    cells.radii[place] = cells.radii[cell];
    cells.densities[place] = cells.densities[cell];
    cells.sources[place] = cells.sources[cell];
    cells.isUnseen[place++] = cells.isUnseen[cell];
  }
  cells.sites.resize(place);
  cells.radii.resize(place);
  cells.densities.resize(place);
  cells.sources.resize(place);
  cells.isUnseen.resize(place);
  return culled;
}

}  // namespace froth
