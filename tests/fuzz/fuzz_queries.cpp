// Any bytes that the reader takes for an asset, packed for the GPU and asked by rays and spheres on the CPU: no crash,
// no leak, no hang, and answers that are numbers.
#include <cmath>
#include <cstdlib>
#include <span>

#include "format/levels.h"
#include "format/read/asset_reader.h"
#include "runtime/asset/cell_packer.h"
#include "runtime/query/foam_walk.h"
#include "runtime/query/query_foam.h"
#include "runtime/query/sphere_overlap.h"

namespace froth {
namespace {

constexpr uint32_t kMostCells = 8;  // of a chunk, through which rays are sent

void expect(bool holds) {
  if (!holds) std::abort();
}

void ask(const QueryFoam& foam, const glm::dvec3& point) {
  (void)foam.locate(point);
  for (int axis = 0; axis < 3; ++axis) {
    FoamRay ray{point, glm::dvec3(0), HUGE_VAL};
    ray.direction[axis] = 1;
    FoamWalk walk(foam, ray, {1000, 1u << 20});
    for (FoamSegment segment; walk.next(segment);) expect(segment.tNear < segment.tFar && segment.density >= 0);
  }
  const std::optional<SolidContact> contact =
      SphereOverlap(foam, point, 0.7, std::pmr::get_default_resource()).findNearest(1e6);
  expect(!contact || std::isfinite(contact->distance));
}

void use(const AssetReader& reader) {
  const AssetContents& asset = reader.manifest();
  QueryFoam foam(asset);
  std::vector<glm::dvec3> points;
  for (uint32_t index = 0; index < asset.chunks.size(); ++index) {
    const Result<CodedChunk> coded = reader.readCodedChunk(index);
    if (!coded) return;
    const ChunkContents* chunk = &coded->contents;
    (void)packCells(*chunk, coded->codes, asset);
    if (asset.levels.empty()) {
      foam.addChunk(makeQueryChunk(*chunk), findLiveBounds(*chunk));
    } else if (asset.hasWalkGraph) {
      foam.setChunk(index, makeQueryChunk(*chunk));
    }
    for (uint32_t cell = 0; cell < chunk->cellCount && cell < kMostCells; ++cell) {
      points.push_back(glm::dvec3(chunk->origin[0], chunk->origin[1], chunk->origin[2]) +
                       glm::dvec3(chunk->sites[cell]));
    }
  }
  const auto askAll = [&] {
    if (!foam.hasWalkGraph() || !foam.hasCells()) return;
    for (const glm::dvec3& point : points) ask(foam, point);
  };
  if (asset.levels.empty()) {
    foam.finish();
    askAll();
  }
  for (uint32_t level = countLevels(asset.levels); level-- > 0 && !asset.levels.empty();) {
    std::vector<uint32_t> cut;
    for (uint32_t index = 0; index < asset.chunks.size(); ++index) {
      if (isInLevel(asset.levels[index], level)) cut.push_back(index);
    }
    foam.show(foam.makeCut(cut));
    askAll();
  }
}

}  // namespace
}  // namespace froth

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (const froth::Result<froth::AssetReader> reader = froth::AssetReader::openBytes({data, size}, "fuzz.froth")) {
    froth::use(*reader);
  }
  return 0;
}
