// The way back: from the contents of an asset to a foam.
#include <cstddef>
#include <limits>

#include "baker/bake/bake.h"

namespace froth {
namespace {

Status checkChunk(const AssetContents& contents, size_t index) {
  const ChunkContents& chunk = contents.chunks[index];
  const size_t live = chunk.liveCount, details = live * contents.detailCount,
               lobes = details * contents.lobeCount;
  const bool isWhole = live <= chunk.cellCount && chunk.sites.size() == chunk.cellCount &&
                       chunk.radii.size() == chunk.cellCount && chunk.densities.size() == live &&
                       chunk.orientations.size() == live && chunk.detailSites.size() == details &&
                       (chunk.detailHeights.empty() || chunk.detailHeights.size() == details) &&
                       chunk.lobeAxes.size() == lobes && chunk.lobeColours.size() == lobes;
  if (isWhole) return {};
  return makeError(ErrorKind::kBadInput,
                   "asset: chunk %zu: an array's length does not match %u cells, %u of them live; "
                   "bake the scene again",
                   index, chunk.cellCount, chunk.liveCount);
}

// Appends the values of live cells, then `filler` for the other cells of the chunk.
template <class T>
void append(std::vector<T>& all, const std::vector<T>& values, size_t fillers, const T& filler) {
  all.insert(all.end(), values.begin(), values.end());
  all.insert(all.end(), fillers, filler);
}

void appendChunk(const ChunkContents& chunk, Foam& foam) {
  const glm::dvec3 origin(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
  for (const glm::vec3& site : chunk.sites) foam.sites.emplace_back(origin + glm::dvec3(site));
  foam.radii.insert(foam.radii.end(), chunk.radii.begin(), chunk.radii.end());

  const size_t bare = chunk.cellCount - chunk.liveCount;
  const size_t bareDetails = bare * foam.detailCount, bareLobes = bareDetails * foam.lobeCount;
  append(foam.densities, chunk.densities, bare, 0.0f);
  append(foam.orientations, chunk.orientations, bare, glm::vec4(1, 0, 0, 0));
  append(foam.detailSites, chunk.detailSites, bareDetails, glm::vec2(0));
  const size_t flatDetails = chunk.detailHeights.empty() ? size_t{chunk.liveCount} * foam.detailCount : 0;
  append(foam.detailHeights, chunk.detailHeights, flatDetails + bareDetails, 0.0f);
  append(foam.lobeAxes, chunk.lobeAxes, bareLobes, glm::vec3(0));
  append(foam.lobeColours, chunk.lobeColours, bareLobes, glm::vec3(0));  // an offset of 0 is grey
}

}  // namespace

Result<Foam> foamFromAsset(const AssetContents& contents) {
  uint64_t cellCount = 0;
  for (size_t index = 0; index < contents.chunks.size(); ++index) {
    if (Status status = checkChunk(contents, index); !status) return status.error();
    cellCount += contents.chunks[index].cellCount;
  }
  if (cellCount == 0 || cellCount > std::numeric_limits<uint32_t>::max()) {
    return makeError(ErrorKind::kBadInput, "asset: %llu cells; a foam has 1 to 4294967295",
                     static_cast<unsigned long long>(cellCount));
  }

  Foam foam;
  foam.cellCount = static_cast<uint32_t>(cellCount);
  foam.detailCount = contents.detailCount;
  foam.lobeCount = contents.lobeCount;
  foam.sites.reserve(cellCount);
  foam.lobeAxes.reserve(cellCount * foam.detailCount * foam.lobeCount);
  foam.lobeColours.reserve(cellCount * foam.detailCount * foam.lobeCount);
  for (const ChunkContents& chunk : contents.chunks) appendChunk(chunk, foam);
  return foam;
}

}  // namespace froth
