#include "baker/verify/scene_check.h"

#include <optional>

#include "baker/bake/solid_balls.h"
#include "baker/graph/diagram_check.h"
#include "baker/verify/scene_graph.h"

namespace froth {
namespace {

constexpr uint64_t kSeed = 1;  // of the samples

Status checkSolidBalls(const AssetContents& contents) {
  for (size_t index = 0; index < contents.chunks.size(); ++index) {
    const ChunkContents& chunk = contents.chunks[index];
    const std::optional<uint32_t> wrong = findWrongSolidBall(chunk, contents.detailCount);
    if (wrong) {
      return makeError(
          ErrorKind::kBadInput,
          "chunk %zu: the solid ball of cell %u (bytes %08x) does not hold the cell's solid part; bake the scene again",
          index, *wrong, chunk.solidBalls[*wrong]);
    }
  }
  return {};
}

}  // namespace

Result<ValidityReport> checkScene(const AssetContents& contents, const Progress& progress) {
  const Result<SceneGraph> scene = joinChunks(contents, progress);
  if (!scene) return scene.error();
  ValidityReport found;
  found.cells = scene->sites.size();
  found.walkPairs = scene->triangulation.graph.neighbours.size() / 2;
  found.alphaPairs = scene->alpha.graph.neighbours.size() / 2;
  if (!sampleDiagram(scene->sites, scene->radii, scene->triangulation, scene->alpha, kSeed, progress, found)) {
    return stoppedOnRequest("verify");
  }
  if (!found.faults.empty()) {
    return makeError(ErrorKind::kBadInput, "graphs: %s; bake the scene again", found.faults.front().c_str());
  }
  if (Status status = checkSolidBalls(contents); !status) return status.error();
  return found;
}

}  // namespace froth
