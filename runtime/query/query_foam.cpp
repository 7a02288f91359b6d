#include "runtime/query/query_foam.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "format/checks.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

// Of this many cells one is an entry: from the nearest of them it is a few steps to any cell. 1 byte per cell.
constexpr uint32_t kCellsPerEntry = 16;

template <class T>
uint64_t bytesOf(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

// QueryChunk::neighbours
std::vector<uint32_t> sortRows(const ChunkContents& contents) {
  std::vector<uint32_t> sorted = contents.neighbours;
  for (uint32_t cell = 0; cell < contents.cellCount; ++cell) {
    std::sort(sorted.begin() + contents.neighbourOffsets[cell], sorted.begin() + contents.neighbourOffsets[cell + 1]);
  }
  return sorted;
}

std::vector<QueryDetail> joinDetails(const ChunkContents& contents) {
  std::vector<QueryDetail> details;
  details.reserve(contents.detailHeights.size());
  for (size_t i = 0; i < contents.detailHeights.size(); ++i) {
    details.push_back({contents.detailSites[i], contents.detailHeights[i]});
  }
  return details;
}

}  // namespace

QueryChunk makeQueryChunk(const ChunkContents& contents) {
  QueryChunk chunk;
  chunk.origin = {contents.origin[0], contents.origin[1], contents.origin[2]};
  chunk.cellCount = contents.cellCount;
  chunk.liveCount = contents.liveCount;
  chunk.siteRadius = joinSitesAndRadii(contents);
  chunk.neighbourOffsets = contents.neighbourOffsets;
  chunk.neighbours = packElements(sortRows(contents));
  chunk.ghostRefs = contents.ghostRefs;
  chunk.borders.reserve(contents.borderCells.size());
  for (size_t i = 0; i < contents.borderCells.size(); ++i) {
    chunk.borders.push_back({contents.borderCells[i], contents.borderNumbers[i]});
  }
  chunk.densities = contents.densities;
  chunk.orientations = contents.orientations;
  chunk.details = joinDetails(contents);
  chunk.balls = makeBallTree(std::span(chunk.siteRadius).first(chunk.liveCount));
  return chunk;
}

uint64_t QueryChunk::arrayBytes() const {
  return bytesOf(siteRadius) + bytesOf(neighbourOffsets) + bytesOf(neighbours.words) + bytesOf(ghostRefs) +
         bytesOf(borders) + bytesOf(densities) + bytesOf(orientations) + bytesOf(details) + balls.bytes();
}

QueryFoam::QueryFoam(const AssetContents& manifest, const LiveBounds& bounds)
    : hasWalkGraph_(manifest.hasWalkGraph),
      hasLevels_(!manifest.levels.empty()),
      detailCount_(manifest.detailCount),
      localBits_(manifest.localBits),
      detailSharpness_(manifest.detailSharpness),
      bounds_(bounds) {
  if (!hasLevels_ || !hasWalkGraph_) return;
  chunks_.resize(manifest.chunks.size());
  borders_.assign(manifest.borderCount, kNowhere);
  bytes_ = chunks_.size() * sizeof(QueryChunk) + bytesOf(borders_);
}

void QueryFoam::addChunk(QueryChunk&& made, const LiveBounds& bounds) {
  if (!hasWalkGraph_) return;
  const QueryChunk& chunk = chunks_.emplace_back(std::move(made));
  bounds_.low = glm::min(bounds_.low, bounds.low);
  bounds_.high = glm::max(bounds_.high, bounds.high);
  const auto index = static_cast<uint32_t>(chunks_.size() - 1);
  for (uint32_t cell = 0; cell < chunk.cellCount; cell += kCellsPerEntry) {
    samples_.push_back({glm::vec3(chunk.origin + chunk.siteOf(cell)), {index, cell}});
  }
  bytes_ += sizeof(QueryChunk) + chunk.arrayBytes();
}

// Bit for bit on a lattice, else rounded to float: as format/read/asset_verify.cpp.
Status QueryFoam::checkGhosts(const std::string& name) const {
  for (uint32_t index = 0; index < chunks_.size(); ++index) {
    const QueryChunk& chunk = chunks_[index];
    for (uint32_t ghost = 0; ghost < chunk.ghostRefs.size(); ++ghost) {
      const CellAddress cell = cellOfSite({index, 0}, chunk.cellCount + ghost);
      const QueryChunk& other = chunks_[cell.chunk];
      const glm::vec4 copy = chunk.siteRadius[chunk.cellCount + ghost], original = other.siteRadius[cell.cell];
      const glm::vec3 expected(other.origin - chunk.origin + glm::dvec3(original));
      if (glm::vec3(copy) == expected && copy.w == original.w) continue;
      return makeError(ErrorKind::kBadInput,
                       "%s: ghost %u is not where cell %u of chunk %u is, or not as large; bake the scene again",
                       chunkPlace(name, index).c_str(), ghost, cell.cell, cell.chunk);
    }
  }
  return {};
}

void QueryFoam::finish() {
  isWhole_ = true;
  if (samples_.empty()) return;
  std::vector<uint32_t> all(chunks_.size());
  std::iota(all.begin(), all.end(), 0u);
  takeCut(makeTrees(std::move(all), std::move(samples_)));
  samples_ = {};
}

double QueryFoam::meanHeightOf(const QueryChunk& chunk, uint32_t cell) const {
  if (chunk.details.empty()) return 0;
  double sum = 0;
  for (uint32_t k = 0; k < detailCount_; ++k) sum += chunk.details[size_t{cell} * detailCount_ + k].height;
  return sum / detailCount_;
}

CellAddress QueryFoam::cellOfSite(CellAddress from, uint32_t site) const {
  const QueryChunk& chunk = chunks_[from.chunk];
  if (site < chunk.cellCount) return {from.chunk, site};
  CellRef ref = chunk.ghostRefs[site - chunk.cellCount];
  if (hasLevels_) {
    ref = borders_[ref];
    if (ref == kNowhere) return from;
  }
  return {chunkOf(ref, localBits_), localOf(ref, localBits_)};
}

}  // namespace froth
