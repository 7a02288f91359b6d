#include "baker/lod/choose_pairs.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "foam/site_tree.h"

namespace froth {
namespace {

constexpr int kRounds = 4;  // each pairs up those whose nearest neighbour is taken

struct Candidate {
  double distance;
  uint32_t first, second;
  bool operator<(const Candidate& other) const {
    return std::tie(distance, first, second) < std::tie(other.distance, other.first, other.second);
  }
};

Candidate findNearest(const SiteTree& tree, const Foam& cells, uint32_t cell) {
  Candidate best{std::numeric_limits<double>::infinity(), cell, cell};
  const glm::dvec3 site(cells.sites[cell]);
  const auto bound = [&](const SiteTree::Node& node) { return glm::length(gapTo(node.box, site)); };
  tree.search(best.distance, bound, [&](uint32_t place) {
    const uint32_t other = tree.order()[place];
    if (other == cell) return;
    const Candidate found{glm::distance(site, glm::dvec3(cells.sites[other])), cell, other};
    best = std::min(best, found);
  });
  return best;
}

}  // namespace

// Nearest pairs.
std::vector<CellPair> choosePairs(const Foam& cells, std::span<const uint8_t> isLocked, std::span<const double>,
                                  size_t most) {
  std::vector<uint8_t> isTaken(isLocked.begin(), isLocked.end());
  std::vector<CellPair> pairs;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<uint32_t> open;
    for (uint32_t cell = 0; cell < cells.cellCount; ++cell) {
      if (!isTaken[cell]) open.push_back(cell);
    }
    if (open.size() < 2) break;
    const SiteTree tree(cells.sites, cells.radii, open);
    std::vector<Candidate> candidates;
    for (const uint32_t cell : open) candidates.push_back(findNearest(tree, cells, cell));
    std::sort(candidates.begin(), candidates.end());
    for (const Candidate& candidate : candidates) {
      if (pairs.size() == most) return pairs;
      if (isTaken[candidate.first] || isTaken[candidate.second]) continue;
      isTaken[candidate.first] = isTaken[candidate.second] = 1;
      pairs.push_back({candidate.first, candidate.second});
    }
  }
  return pairs;
}

}  // namespace froth
