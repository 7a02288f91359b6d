#include "baker/bake/asset_foam.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "baker/bake/bake.h"
#include "format/chunk_lobes.h"
#include "format/levels.h"

namespace froth {
namespace {

Status checkChunk(const AssetContents& contents, size_t index) {
  const ChunkContents& chunk = contents.chunks[index];
  const size_t live = chunk.liveCount, details = live * contents.detailCount;
  const size_t sites = size_t{chunk.cellCount} + chunk.ghostCount, lobes = countLobes(contents, chunk);
  const auto isAbsentOr = [](size_t found, size_t expected) { return found == 0 || found == expected; };
  const bool isWhole = live <= chunk.cellCount && chunk.sites.size() == sites && chunk.radii.size() == sites &&
                       chunk.densities.size() == live && chunk.orientations.size() == live &&
                       chunk.detailSites.size() == details && isAbsentOr(chunk.detailHeights.size(), details) &&
                       isAbsentOr(chunk.baseColours.size(), details) && isAbsentOr(chunk.lobeCounts.size(), details) &&
                       chunk.lobeAxes.size() == lobes && chunk.lobeColours.size() == lobes;
  if (isWhole) return {};
  return makeError(ErrorKind::kBadInput,
                   "asset: chunk %zu: an array's length does not match %u cells, %u of them live; "
                   "bake the scene again",
                   index, chunk.cellCount, chunk.liveCount);
}

// Appends the values of live cells, then `filler` for the other cells of the chunk.
template <class T>
void appendValues(std::vector<T>& all, const std::vector<T>& values, size_t fillers, const T& filler) {
  all.insert(all.end(), values.begin(), values.end());
  all.insert(all.end(), fillers, filler);
}

// The same where an empty array means `filler` for every detail site.
template <class T>
void appendDetails(std::vector<T>& all, const std::vector<T>& values, size_t details, const T& filler) {
  appendValues(all, values, details - values.size(), filler);
}

}  // namespace

FoamAssembler::FoamAssembler(uint32_t detailCount, uint32_t lobeCount, bool hasBaseColours, bool hasLobeOffsets)
    : hasBaseColours_(hasBaseColours), hasLobeOffsets_(hasLobeOffsets) {
  foam_.detailCount = detailCount;
  foam_.lobeCount = lobeCount;
  if (hasLobeOffsets) foam_.lobeOffsets.push_back(0);
}

void FoamAssembler::append(const ChunkContents& chunk) {
  const glm::dvec3 origin(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
  for (uint32_t i = 0; i < chunk.cellCount; ++i) foam_.sites.emplace_back(origin + glm::dvec3(chunk.sites[i]));
  foam_.radii.insert(foam_.radii.end(), chunk.radii.begin(), chunk.radii.begin() + chunk.cellCount);
  foam_.cellCount += chunk.cellCount;

  const size_t bare = chunk.cellCount - chunk.liveCount;
  const size_t bareDetails = bare * foam_.detailCount, details = size_t{chunk.cellCount} * foam_.detailCount;
  appendValues(foam_.densities, chunk.densities, bare, 0.0f);
  appendValues(foam_.orientations, chunk.orientations, bare, glm::vec4(1, 0, 0, 0));
  appendValues(foam_.detailSites, chunk.detailSites, bareDetails, glm::vec2(0));
  appendDetails(foam_.detailHeights, chunk.detailHeights, details, 0.0f);
  if (hasBaseColours_) appendDetails(foam_.baseColours, chunk.baseColours, details, glm::vec3(0));
  appendLobes(chunk, bareDetails);
}

// Cells that are not live have no lobes, or grey ones where every detail site has the same number of them.
void FoamAssembler::appendLobes(const ChunkContents& chunk, size_t bareDetails) {
  const size_t fillers = hasLobeOffsets_ ? 0 : bareDetails * foam_.lobeCount;
  appendValues(foam_.lobeAxes, chunk.lobeAxes, fillers, glm::vec3(0));
  appendValues(foam_.lobeColours, chunk.lobeColours, fillers, glm::vec3(0));
  if (!hasLobeOffsets_) return;
  const size_t liveDetails = size_t{chunk.liveCount} * foam_.detailCount;
  for (size_t detail = 0; detail < liveDetails; ++detail) {
    foam_.lobeOffsets.push_back(foam_.lobeOffsets.back() + lobeCountOf(chunk, foam_.lobeCount, detail));
  }
  foam_.lobeOffsets.insert(foam_.lobeOffsets.end(), bareDetails, foam_.lobeOffsets.back());
}

Result<Foam> foamFromAsset(const AssetContents& contents) {
  const auto isShown = [&](size_t index) { return contents.levels.empty() || contents.levels[index].level == 0; };
  uint64_t cellCount = 0;
  for (size_t index = 0; index < contents.chunks.size(); ++index) {
    if (!isShown(index)) continue;
    if (Status status = checkChunk(contents, index); !status) return status.error();
    cellCount += contents.chunks[index].cellCount;
  }
  if (cellCount == 0 || cellCount > std::numeric_limits<uint32_t>::max()) {
    return makeError(ErrorKind::kBadInput, "asset: %llu cells; a foam has 1 to 4294967295",
                     static_cast<unsigned long long>(cellCount));
  }
  const auto anyChunk = [&](auto&& has) { return std::any_of(contents.chunks.begin(), contents.chunks.end(), has); };
  FoamAssembler assembler(contents.detailCount, contents.lobeCount,
                          anyChunk([](const ChunkContents& chunk) { return !chunk.baseColours.empty(); }),
                          anyChunk([](const ChunkContents& chunk) { return !chunk.lobeCounts.empty(); }));
  for (size_t index = 0; index < contents.chunks.size(); ++index) {
    if (isShown(index)) assembler.append(contents.chunks[index]);
  }
  return assembler.take();
}

}  // namespace froth
