#include "baker/bake/chunk_geometry.h"

#include <algorithm>
#include <limits>
#include <span>

#include "format/graph_rows.h"
#include "format/quantization.h"

namespace froth {
namespace {

class ChunkGeometry {
 public:
  ChunkGeometry(const BakeCells& cells, const ChunkPlan& plan, uint32_t index, const SceneGraphs& graphs)
      : cells_(cells), plan_(plan), index_(index), graphs_(graphs), own_(plan.chunks[index].cells) {
    chunk_.cellCount = static_cast<uint32_t>(own_.size());
    chunk_.liveCount = plan.chunks[index].liveCount;
  }

  ChunkContents fill(double positionStep) {
    findGhosts();
    chooseOrigin(positionStep);
    for (const uint32_t cell : own_) addSite(cell);
    for (const CellRef ref : chunk_.ghostRefs) addSite(plan_.chunks[plan_.chunkOf(ref)].cells[plan_.localOf(ref)]);
    fillRows();
    return std::move(chunk_);
  }

 private:
  // Visits the neighbours in a cell's row, the alpha-complex first; visit(neighbour, isAlpha). Without a walk graph
  // only live cells have rows.
  template <class Visit>
  void visitRow(uint32_t local, Visit&& visit) const {
    const std::span<const uint32_t> alpha = neighboursOf(graphs_.alpha, own_[local]);
    auto next = alpha.end();
    if (local < chunk_.liveCount) {
      for (const uint32_t neighbour : alpha) visit(neighbour, true);
      next = alpha.begin();
    }
    if (!graphs_.hasWalkGraph) return;
    for (const uint32_t neighbour : neighboursOf(graphs_.walk, own_[local])) {
      if (next != alpha.end() && *next == neighbour) {
        ++next;  // both rows ascend
      } else {
        visit(neighbour, false);
      }
    }
  }

  void findGhosts() {
    std::vector<CellRef>& refs = chunk_.ghostRefs;
    for (uint32_t local = 0; local < chunk_.cellCount; ++local) {
      visitRow(local, [&](uint32_t neighbour, bool) {
        if (plan_.chunkOf(plan_.refs[neighbour]) != index_) refs.push_back(plan_.refs[neighbour]);
      });
    }
    std::sort(refs.begin(), refs.end());
    refs.erase(std::unique(refs.begin(), refs.end()), refs.end());
    chunk_.ghostCount = static_cast<uint32_t>(refs.size());
  }

  // The middle of the live cells: the others do not move it, so an image is the same with and without Steiner cells.
  void chooseOrigin(double positionStep) {
    if (positionStep == 0) return;
    const uint32_t count = chunk_.liveCount > 0 ? chunk_.liveCount : chunk_.cellCount;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (uint32_t local = 0; local < count; ++local) {
      const glm::dvec3 site(cells_.sites[own_[local]]);
      low = glm::min(low, site);
      high = glm::max(high, site);
    }
    for (int axis = 0; axis < 3; ++axis) chunk_.origin[axis] = snapToStep(0.5 * (low[axis] + high[axis]), positionStep);
  }

  void addSite(uint32_t cell) {
    const glm::dvec3 origin(chunk_.origin[0], chunk_.origin[1], chunk_.origin[2]);
    chunk_.sites.emplace_back(glm::dvec3(cells_.sites[cell]) - origin);
    chunk_.radii.push_back(cells_.radii[cell]);
  }

  // Of a neighbour, in the chunk's sites.
  uint32_t indexOf(uint32_t cell) const {
    const CellRef ref = plan_.refs[cell];
    if (plan_.chunkOf(ref) == index_) return plan_.localOf(ref);
    const auto ghost = std::lower_bound(chunk_.ghostRefs.begin(), chunk_.ghostRefs.end(), ref);
    return chunk_.cellCount + static_cast<uint32_t>(ghost - chunk_.ghostRefs.begin());
  }

  void fillRows() {
    chunk_.neighbourOffsets.assign(1, 0);
    chunk_.neighbourOffsets.reserve(chunk_.cellCount + size_t{1});
    for (uint32_t local = 0; local < chunk_.cellCount; ++local) {
      uint32_t alphaCount = 0;
      visitRow(local, [&](uint32_t neighbour, bool isAlpha) {
        chunk_.neighbours.push_back(indexOf(neighbour));
        alphaCount += isAlpha;
      });
      if (local < chunk_.liveCount) chunk_.alphaCounts.push_back(alphaCount);
      chunk_.neighbourOffsets.push_back(static_cast<uint32_t>(chunk_.neighbours.size()));
    }
    sortGraphRows(chunk_, 0, chunk_.cellCount);
  }

  const BakeCells& cells_;
  const ChunkPlan& plan_;
  const uint32_t index_;
  const SceneGraphs& graphs_;
  const std::vector<uint32_t>& own_;
  ChunkContents chunk_;
};

}  // namespace

ChunkContents makeChunkGeometry(const BakeCells& cells, const ChunkPlan& plan, uint32_t index,
                                const SceneGraphs& graphs, double positionStep) {
  return ChunkGeometry(cells, plan, index, graphs).fill(positionStep);
}

}  // namespace froth
