#include "foam/cech_pairs.h"

#include <algorithm>
#include <numeric>

#include <tbb/parallel_for.h>

#include "foam/cell_graph.h"
#include "foam/morton_order.h"
#include "foam/site_tree.h"

namespace froth {
namespace {

constexpr uint32_t kBlockSize = 1024;  // rows found by one task
constexpr size_t kBlocksPerLook = 64;  // at the progress
// Bounds are lowered by more than their few roundings of 2^-53, so that the tree never decides a pair: the same
// test does it from both sides, and the graph is symmetric.
constexpr double kGapSlack = 0x1p-48;

// Appends the cells whose balls overlap the ball of `cell`, ascending.
void findOverlaps(std::span<const glm::vec3> sites, std::span<const float> radii, const SiteTree& tree, uint32_t cell,
                  std::vector<uint32_t>& found) {
  const glm::dvec3 centre(sites[cell]);
  const double radius = radii[cell];
  const auto bound = [&](const SiteTree::Node& node) {
    const glm::dvec3 gap = gapTo(node.box, centre);
    const double reach = radius + node.box.maxRadius;
    return glm::dot(gap, gap) * (1 - kGapSlack) - reach * reach;
  };
  const size_t first = found.size();
  tree.search(0.0, bound, [&](uint32_t place) {
    const uint32_t other = tree.order()[place];
    const glm::dvec3 difference = centre - glm::dvec3(sites[other]);
    const double reach = radius + radii[other];
    if (other != cell && glm::dot(difference, difference) < reach * reach) found.push_back(other);
  });
  std::sort(found.begin() + first, found.end());
}

}  // namespace

CellGraph findCechPairs(std::span<const glm::vec3> sites, std::span<const float> radii, const Progress& progress) {
  CellGraph graph;
  graph.offsets.assign(sites.size() + 1, 0);
  if (!report(progress, "overlaps", 0, sites.size())) return {};
  const SiteTree tree(sites, radii, mortonOrder(sites));
  const uint32_t cellCount = static_cast<uint32_t>(sites.size());
  std::vector<std::vector<uint32_t>> blocks((cellCount + kBlockSize - 1) / kBlockSize);
  for (size_t begin = 0; begin < blocks.size(); begin += kBlocksPerLook) {
    if (!report(progress, "overlaps", begin * kBlockSize, sites.size())) return {};
    tbb::parallel_for(begin, std::min(begin + kBlocksPerLook, blocks.size()), [&](size_t block) {
      const uint32_t first = static_cast<uint32_t>(block) * kBlockSize;
      for (uint32_t cell = first; cell < std::min(first + kBlockSize, cellCount); ++cell) {
        const size_t before = blocks[block].size();
        findOverlaps(sites, radii, tree, cell, blocks[block]);
        graph.offsets[cell + 1] = static_cast<uint32_t>(blocks[block].size() - before);
      }
    });
  }
  std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
  graph.neighbours.reserve(graph.offsets.back());
  for (std::vector<uint32_t>& block : blocks) {
    graph.neighbours.insert(graph.neighbours.end(), block.begin(), block.end());
    block = {};
  }
  return graph;
}

}  // namespace froth
