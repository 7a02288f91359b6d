#include "baker/bake/chunk_geometry.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "format/graph_rows.h"
#include "format/quantization.h"

namespace froth {
namespace {

class ChunkGeometry {
 public:
  ChunkGeometry(const BakeCells& cells, const PlannedChunk& planned, const CellRows& rows,
                std::span<const CellRef> refs, const ChunkGeometryOptions& options)
      : cells_(cells), rows_(rows), refs_(refs), options_(options), own_(planned.cells) {
    chunk_.cellCount = static_cast<uint32_t>(own_.size());
    chunk_.liveCount = planned.liveCount;
    for (uint32_t local = 0; local < chunk_.cellCount; ++local) places_.emplace_back(own_[local], local);
    std::sort(places_.begin(), places_.end());
  }

  ChunkContents fill() {
    findGhosts();
    chooseOrigin();
    for (const uint32_t cell : own_) addSite(cell);
    for (const Ghost& ghost : ghosts_) addSite(ghost.cell);
    if (options_.hasLevels) fillBorders();
    fillRows();
    return std::move(chunk_);
  }

 private:
  struct Ghost {
    CellRef ref;
    uint32_t cell;
    auto operator<=>(const Ghost&) const = default;
  };

  // Visits the neighbours in a cell's row, the alpha-complex first; visit(neighbour, isAlpha). Without a walk graph
  // only live cells have rows.
  template <class Visit>
  void visitRow(uint32_t local, Visit&& visit) const {
    const std::span<const uint32_t> alpha = neighboursOf(rows_.alpha, local);
    auto next = alpha.end();
    if (local < chunk_.liveCount) {
      for (const uint32_t neighbour : alpha) visit(neighbour, true);
      next = alpha.begin();
    }
    if (!options_.hasWalkGraph) return;
    for (const uint32_t neighbour : neighboursOf(rows_.walk, local)) {
      if (next != alpha.end() && *next == neighbour) {
        ++next;  // both rows ascend
      } else {
        visit(neighbour, false);
      }
    }
  }

  // The local index of a cell of this chunk.
  std::optional<uint32_t> placeOf(uint32_t cell) const {
    const auto place = std::lower_bound(places_.begin(), places_.end(), std::pair(cell, 0u));
    if (place == places_.end() || place->first != cell) return std::nullopt;
    return place->second;
  }

  void findGhosts() {
    for (uint32_t local = 0; local < chunk_.cellCount; ++local) {
      visitRow(local, [&](uint32_t neighbour, bool) {
        if (!placeOf(neighbour)) ghosts_.push_back({refs_[neighbour], neighbour});
      });
    }
    std::sort(ghosts_.begin(), ghosts_.end());
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
    for (const Ghost& ghost : ghosts_) chunk_.ghostRefs.push_back(ghost.ref);
    chunk_.ghostCount = static_cast<uint32_t>(ghosts_.size());
  }

  // The middle of the live cells: the others do not move it, so an image is the same with and without Steiner cells.
  void chooseOrigin() {
    const double step = options_.positionStep;
    if (step == 0) return;
    const uint32_t count = chunk_.liveCount > 0 ? chunk_.liveCount : chunk_.cellCount;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (uint32_t local = 0; local < count; ++local) {
      const glm::dvec3 site(cells_.sites[own_[local]]);
      low = glm::min(low, site);
      high = glm::max(high, site);
    }
    for (int axis = 0; axis < 3; ++axis) chunk_.origin[axis] = snapToStep(0.5 * (low[axis] + high[axis]), step);
  }

  void addSite(uint32_t cell) {
    const glm::dvec3 origin(chunk_.origin[0], chunk_.origin[1], chunk_.origin[2]);
    chunk_.sites.emplace_back(glm::dvec3(cells_.sites[cell]) - origin);
    chunk_.radii.push_back(cells_.radii[cell]);
  }

  void fillBorders() {
    for (uint32_t local = 0; local < chunk_.cellCount; ++local) {
      if (refs_[own_[local]] == kNoRef) continue;
      chunk_.borderCells.push_back(local);
      chunk_.borderNumbers.push_back(refs_[own_[local]]);
    }
  }

  // Of a neighbour, in the chunk's sites.
  uint32_t indexOf(uint32_t cell) const {
    if (const std::optional<uint32_t> place = placeOf(cell)) return *place;
    const auto ghost = std::lower_bound(ghosts_.begin(), ghosts_.end(), Ghost{refs_[cell], cell});
    return chunk_.cellCount + static_cast<uint32_t>(ghost - ghosts_.begin());
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
  const CellRows& rows_;
  std::span<const CellRef> refs_;
  const ChunkGeometryOptions& options_;
  const std::vector<uint32_t>& own_;
  std::vector<std::pair<uint32_t, uint32_t>> places_;  // cell of the scene, local index; ascending
  std::vector<Ghost> ghosts_;                          // ascending
  ChunkContents chunk_;
};

}  // namespace

ChunkContents makeChunkGeometry(const BakeCells& cells, const PlannedChunk& planned, const CellRows& rows,
                                std::span<const CellRef> refs, const ChunkGeometryOptions& options) {
  return ChunkGeometry(cells, planned, rows, refs, options).fill();
}

}  // namespace froth
