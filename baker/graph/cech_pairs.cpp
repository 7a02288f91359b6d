// Cech pairs: overlapping balls, found through a bounding volume hierarchy.
#include <algorithm>
#include <bit>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "baker/graph/graph.h"

namespace froth {
namespace {

constexpr uint32_t kLeafSize = 8;
constexpr uint32_t kBlockSize = 1024;  // rows found by one task
// Boxes and queries are widened by several roundings of 2^-53, so that the tree never decides a pair: the
// exact same test does it from both sides, and the graph is symmetric.
constexpr double kSlack = 0x1p-48;

struct Bounds {
  glm::dvec3 low{INFINITY}, high{-INFINITY};
};

Bounds unite(const Bounds& a, const Bounds& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

// Implicit binary tree over the balls in Morton order: node k has children 2k and 2k + 1; leaf l is node
// leafCount + l and holds balls [l * kLeafSize, (l + 1) * kLeafSize). Boxes bound whole balls, so radii may
// differ by decades.
class BallTree {
 public:
  BallTree(std::span<const glm::vec3> sites, std::span<const float> radii)
      : sites_(sites), radii_(radii), order_(mortonOrder(sites)) {
    leafCount_ = std::bit_ceil(static_cast<uint32_t>((order_.size() + kLeafSize - 1) / kLeafSize));
    boxes_.resize(size_t{2} * leafCount_);
    for (size_t k = 0; k < order_.size(); ++k) {
      const glm::dvec3 centre(sites[order_[k]]);
      const glm::dvec3 reach = double{radii[order_[k]]} * (1 + kSlack) + kSlack * glm::abs(centre);
      Bounds& box = boxes_[leafCount_ + k / kLeafSize];
      box = unite(box, {centre - reach, centre + reach});
    }
    for (size_t node = leafCount_ - 1; node >= 1; --node)
      boxes_[node] = unite(boxes_[2 * node], boxes_[2 * node + 1]);
  }

  // Appends the cells whose balls overlap the ball of `cell`, ascending.
  void findOverlaps(uint32_t cell, std::vector<uint32_t>& found) const {
    const size_t first = found.size();
    visit(1, cell, found);
    std::sort(found.begin() + first, found.end());
  }

 private:
  void visit(size_t node, uint32_t cell, std::vector<uint32_t>& found) const {
    if (!touches(boxes_[node], cell)) return;
    if (node < leafCount_) {
      visit(2 * node, cell, found);
      visit(2 * node + 1, cell, found);
      return;
    }
    const size_t begin = (node - leafCount_) * kLeafSize;
    const size_t end = std::min(begin + kLeafSize, order_.size());
    for (size_t k = begin; k < end; ++k) {
      if (order_[k] != cell && overlaps(order_[k], cell)) found.push_back(order_[k]);
    }
  }

  bool touches(const Bounds& box, uint32_t cell) const {
    const glm::dvec3 centre(sites_[cell]);
    const glm::dvec3 gap = glm::max(glm::max(box.low - centre, centre - box.high), glm::dvec3(0));
    const double reach = radii_[cell] * (1 + kSlack);
    return glm::dot(gap, gap) <= reach * reach;
  }

  bool overlaps(uint32_t a, uint32_t b) const {
    const glm::dvec3 difference = glm::dvec3(sites_[a]) - glm::dvec3(sites_[b]);
    const double reach = double{radii_[a]} + radii_[b];
    return glm::dot(difference, difference) < reach * reach;
  }

  std::span<const glm::vec3> sites_;
  std::span<const float> radii_;
  std::vector<uint32_t> order_;
  uint32_t leafCount_;
  std::vector<Bounds> boxes_;
};

}  // namespace

CellGraph findCechPairs(std::span<const glm::vec3> sites, std::span<const float> radii) {
  CellGraph graph;
  graph.offsets.assign(sites.size() + 1, 0);
  if (sites.empty()) return graph;

  const BallTree tree(sites, radii);
  const uint32_t cellCount = static_cast<uint32_t>(sites.size());
  std::vector<std::vector<uint32_t>> blocks((cellCount + kBlockSize - 1) / kBlockSize);
  tbb::parallel_for(size_t{0}, blocks.size(), [&](size_t block) {
    const uint32_t first = static_cast<uint32_t>(block) * kBlockSize;
    for (uint32_t cell = first; cell < std::min(first + kBlockSize, cellCount); ++cell) {
      const size_t before = blocks[block].size();
      tree.findOverlaps(cell, blocks[block]);
      graph.offsets[cell + 1] = static_cast<uint32_t>(blocks[block].size() - before);
    }
  });
  std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
  graph.neighbours.reserve(graph.offsets.back());
  for (std::vector<uint32_t>& block : blocks) {
    graph.neighbours.insert(graph.neighbours.end(), block.begin(), block.end());
    block = {};
  }
  return graph;
}

}  // namespace froth
