#include "baker/lod/merge_cells.h"

#include <cmath>
#include <utility>
#include <vector>

#include "foam/append_cells.h"

namespace froth {

// The face of the one that shows more, at their weighted mean, in a ball as large as both.
Foam mergePairs(const Foam& cells, std::span<const CellPair> pairs, std::span<const double> contributions) {
  std::vector<uint32_t> heavier;
  std::vector<double> weights;  // of the heavier one
  for (const CellPair& pair : pairs) {
    double first = contributions.empty() ? 1 : contributions[pair.first];
    double second = contributions.empty() ? 1 : contributions[pair.second];
    heavier.push_back(first >= second ? pair.first : pair.second);
    weights.push_back(first + second > 0 ? std::fmax(first, second) / (first + second) : 0.5);
  }
  Foam merged;
  appendCells(cells, heavier, merged);
  for (size_t k = 0; k < pairs.size(); ++k) {
    const uint32_t from = heavier[k], other = pairs[k].first ^ pairs[k].second ^ from;
    const double weight = weights[k];
    merged.sites[k] = glm::mix(glm::dvec3(cells.sites[other]), glm::dvec3(cells.sites[from]), weight);
    merged.radii[k] = std::cbrt(std::pow(cells.radii[from], 3.0f) + std::pow(cells.radii[other], 3.0f));
    merged.densities[k] = static_cast<float>(std::lerp(cells.densities[other], cells.densities[from], weight));
  }
  return merged;
}

}  // namespace froth
