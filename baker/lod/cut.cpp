#include "baker/lod/cut.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "baker/cells/chunk_plan.h"

namespace froth {
namespace {

bool isDrawn(const ChunkLevel& place, std::span<const uint8_t> isRefined) {
  return (place.in == kNoGroup || isRefined[place.in]) && (place.madeBy == kNoGroup || !isRefined[place.madeBy]);
}

glm::dvec3 worldSite(const ChunkContents& chunk, uint32_t site) {
  return glm::dvec3(chunk.origin[0], chunk.origin[1], chunk.origin[2]) + glm::dvec3(chunk.sites[site]);
}

// Ghosts in the order of their references, which the neighbours follow.
void sortGhosts(ChunkContents& chunk) {
  std::vector<uint32_t> order(chunk.ghostCount), places(chunk.ghostCount);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return chunk.ghostRefs[a] < chunk.ghostRefs[b]; });
  const ChunkContents before = chunk;
  for (uint32_t k = 0; k < chunk.ghostCount; ++k) {
    places[order[k]] = k;
    chunk.ghostRefs[k] = before.ghostRefs[order[k]];
    chunk.sites[chunk.cellCount + k] = before.sites[chunk.cellCount + order[k]];
    chunk.radii[chunk.cellCount + k] = before.radii[chunk.cellCount + order[k]];
  }
  for (uint32_t& neighbour : chunk.neighbours) {
    if (neighbour >= chunk.cellCount) neighbour = chunk.cellCount + places[neighbour - chunk.cellCount];
  }
}

// All but the chunks.
AssetContents headerOf(const AssetContents& contents) {
  AssetContents header;
  header.detailCount = contents.detailCount;
  header.lobeCount = contents.lobeCount;
  header.hasWalkGraph = contents.hasWalkGraph;
  header.detailSharpness = contents.detailSharpness;
  header.nearRatio = contents.nearRatio;
  header.nearDepth = contents.nearDepth;
  header.quantization = contents.quantization;
  header.axisCodebook = contents.axisCodebook;
  return header;
}

Status resolveGhosts(std::span<const CellRef> refOfBorder, AssetContents& cut) {
  for (size_t index = 0; index < cut.chunks.size(); ++index) {
    ChunkContents& chunk = cut.chunks[index];
    for (uint32_t ghost = 0; ghost < chunk.ghostCount; ++ghost) {
      const uint32_t border = chunk.ghostRefs[ghost], site = chunk.cellCount + ghost;
      const CellRef ref = refOfBorder[border];
      const ChunkContents* home = ref == kNoRef ? nullptr : &cut.chunks[uint64_t{ref} >> cut.localBits];
      const auto local = static_cast<uint32_t>(ref & ((uint64_t{1} << cut.localBits) - 1));
      if (!home || worldSite(*home, local) != worldSite(chunk, site) || home->radii[local] != chunk.radii[site]) {
        return makeError(ErrorKind::kBadInput,
                         "levels: border %u, a ghost of drawn chunk %zu, is %s; bake the scene again", border, index,
                         home ? "another cell where it is drawn" : "not drawn");
      }
      chunk.ghostRefs[ghost] = ref;
    }
    sortGhosts(chunk);
  }
  return {};
}

}  // namespace

Result<AssetContents> contentsOfCut(const AssetContents& contents, std::span<const uint8_t> isRefined) {
  if (contents.levels.empty()) return contents;
  AssetContents cut = headerOf(contents);
  for (size_t index = 0; index < contents.chunks.size(); ++index) {
    if (isDrawn(contents.levels[index], isRefined)) cut.chunks.push_back(contents.chunks[index]);
  }
  cut.localBits = contents.localBits;
  std::vector<CellRef> refOfBorder(contents.borderCount, kNoRef);
  for (uint32_t index = 0; index < cut.chunks.size(); ++index) {
    ChunkContents& chunk = cut.chunks[index];
    const auto base = static_cast<CellRef>(uint64_t{index} << cut.localBits);
    for (size_t k = 0; k < chunk.borderCells.size(); ++k) {
      refOfBorder[chunk.borderNumbers[k]] = base | chunk.borderCells[k];
    }
    chunk.borderCells = chunk.borderNumbers = {};
  }
  if (Status status = resolveGhosts(refOfBorder, cut); !status) return status.error();
  return cut;
}

}  // namespace froth
