#include "tests/render/split_asset.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

namespace froth::test {
namespace {

constexpr uint32_t kLocalBits = 20;

using Members = std::vector<uint32_t>;  // cells of the whole asset in one chunk

// Halves `cells` at the median along the axis on which they reach farthest, until there are `count` parts.
void splitCells(const ChunkContents& whole, std::span<uint32_t> cells, uint32_t count, std::vector<Members>& parts) {
  if (count == 1) {
    Members& part = parts.emplace_back(cells.begin(), cells.end());
    std::sort(part.begin(), part.end());  // live cells first, as in the whole
    return;
  }
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const uint32_t cell : cells) {
    low = glm::min(low, whole.sites[cell]);
    high = glm::max(high, whole.sites[cell]);
  }
  const glm::vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t middle = cells.size() * (count / 2) / count;
  std::nth_element(
      cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(middle), cells.end(),
      [&](uint32_t a, uint32_t b) { return std::pair(whole.sites[a][axis], a) < std::pair(whole.sites[b][axis], b); });
  splitCells(whole, cells.first(middle), count / 2, parts);
  splitCells(whole, cells.subspan(middle), count - count / 2, parts);
}

std::array<double, 3> originOf(const ChunkContents& whole, const Members& members, double grid) {
  std::array<double, 3> origin{};
  for (int axis = 0; axis < 3 && grid > 0; ++axis) {
    origin[static_cast<size_t>(axis)] = grid * std::round(double{whole.sites[members[0]][axis]} / grid);
  }
  return origin;
}

template <class T>
void copyValues(const std::vector<T>& from, uint32_t cell, uint32_t perCell, std::vector<T>& to) {
  if (from.empty()) return;
  const auto first = from.begin() + std::ptrdiff_t{cell} * perCell;
  to.insert(to.end(), first, first + perCell);
}

void copyLiveCell(const ChunkContents& whole, uint32_t cell, uint32_t details, uint32_t lobes, ChunkContents& chunk) {
  ++chunk.liveCount;
  copyValues(whole.alphaCounts, cell, 1, chunk.alphaCounts);
  copyValues(whole.densities, cell, 1, chunk.densities);
  copyValues(whole.orientations, cell, 1, chunk.orientations);
  copyValues(whole.cellColours, cell, 1, chunk.cellColours);
  copyValues(whole.cellHeights, cell, 1, chunk.cellHeights);
  copyValues(whole.solidBalls, cell, 1, chunk.solidBalls);
  copyValues(whole.detailSites, cell, details, chunk.detailSites);
  copyValues(whole.detailHeights, cell, details, chunk.detailHeights);
  copyValues(whole.baseColours, cell, details, chunk.baseColours);
  copyValues(whole.lobeAxes, cell, details * lobes, chunk.lobeAxes);
  copyValues(whole.lobeColours, cell, details * lobes, chunk.lobeColours);
}

}  // namespace

AssetContents splitAsset(const AssetContents& contents, uint32_t count, double grid) {
  const ChunkContents& whole = contents.chunks[0];
  Members all(whole.cellCount);
  std::iota(all.begin(), all.end(), 0u);
  std::vector<Members> parts;
  splitCells(whole, all, count, parts);

  std::vector<CellRef> refOf(whole.cellCount);
  for (uint32_t part = 0; part < count; ++part) {
    for (uint32_t local = 0; local < parts[part].size(); ++local) {
      refOf[parts[part][local]] = part << kLocalBits | local;
    }
  }
  std::vector<glm::dvec3> origins;
  for (const Members& part : parts) {
    const std::array<double, 3> origin = originOf(whole, part, grid);
    origins.emplace_back(origin[0], origin[1], origin[2]);
  }
  AssetContents result = contents;
  result.localBits = kLocalBits;
  result.chunks.assign(count, {});
  for (uint32_t part = 0; part < count; ++part) {
    ChunkContents& chunk = result.chunks[part];
    const glm::dvec3 origin = origins[part];
    chunk.origin = {origin.x, origin.y, origin.z};
    chunk.cellCount = static_cast<uint32_t>(parts[part].size());
    const auto addSite = [&](uint32_t cell) {  // a ghost: as its own chunk holds it
      const glm::dvec3 home = origins[refOf[cell] >> kLocalBits];
      chunk.sites.emplace_back(home - origin + glm::dvec3(glm::vec3(glm::dvec3(whole.sites[cell]) - home)));
      chunk.radii.push_back(whole.radii[cell]);
    };
    std::map<CellRef, uint32_t> ghosts;  // to the cell of the whole asset
    const auto rowOf = [&](uint32_t cell) {
      return std::span(whole.neighbours)
          .subspan(whole.neighbourOffsets[cell], whole.neighbourOffsets[cell + 1] - whole.neighbourOffsets[cell]);
    };
    for (const uint32_t cell : parts[part]) {
      addSite(cell);
      if (cell < whole.liveCount) copyLiveCell(whole, cell, contents.detailCount, contents.lobeCount, chunk);
      for (const uint32_t other : rowOf(cell)) {
        if (refOf[other] >> kLocalBits != part) ghosts[refOf[other]] = other;
      }
    }
    std::map<CellRef, uint32_t> ghostSites;
    for (const auto& [ref, cell] : ghosts) {
      ghostSites[ref] = static_cast<uint32_t>(chunk.sites.size());
      chunk.ghostRefs.push_back(ref);
      addSite(cell);
    }
    chunk.ghostCount = static_cast<uint32_t>(ghosts.size());
    chunk.neighbourOffsets.push_back(0);
    for (const uint32_t cell : parts[part]) {
      for (const uint32_t other : rowOf(cell)) {
        const CellRef ref = refOf[other];
        const bool isOwn = ref >> kLocalBits == part;
        chunk.neighbours.push_back(isOwn ? ref & ((1u << kLocalBits) - 1) : ghostSites[ref]);
      }
      chunk.neighbourOffsets.push_back(static_cast<uint32_t>(chunk.neighbours.size()));
    }
  }
  return result;
}

}  // namespace froth::test
