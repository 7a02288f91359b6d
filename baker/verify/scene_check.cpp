#include "baker/verify/scene_check.h"

#include <optional>

#include "baker/bake/solid_balls.h"
#include "baker/graph/diagram_check.h"
#include "baker/verify/level_scene.h"
#include "baker/verify/scene_graph.h"
#include "format/levels.h"

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

// Adds what was sampled of the graphs to `found`.
Status checkDiagram(const AssetContents& contents, const Progress& progress, ValidityReport& found) {
  const Result<SceneGraph> scene = joinChunks(contents, progress);
  if (!scene) return scene.error();
  ValidityReport sampled;
  if (!sampleDiagram(scene->sites, scene->radii, scene->triangulation, scene->alpha, kSeed, progress, sampled)) {
    return stoppedOnRequest("verify");
  }
  if (!sampled.faults.empty()) {
    return makeError(ErrorKind::kBadInput, "graphs: %s; bake the scene again", sampled.faults.front().c_str());
  }
  found.cells += scene->sites.size();
  found.walkPairs += scene->triangulation.graph.neighbours.size() / 2;
  found.alphaPairs += scene->alpha.graph.neighbours.size() / 2;
  found.pointsChecked += sampled.pointsChecked;
  found.raysChecked += sampled.raysChecked;
  return {};
}

}  // namespace

Result<ValidityReport> checkScene(const AssetContents& contents, const Progress& progress) {
  ValidityReport found;
  if (contents.levels.empty()) {
    if (Status status = checkDiagram(contents, progress, found); !status) return status.error();
  }
  for (uint32_t level = 0; !contents.levels.empty() && level < countLevels(contents.levels); ++level) {
    const Status status = checkDiagram(sceneOfLevel(contents, level), progress, found);
    if (!status) {
      return makeError(status.error().kind, "level %u: %s", level, status.error().message.c_str());
    }
  }
  if (Status status = checkSolidBalls(contents); !status) return status.error();
  return found;
}

}  // namespace froth
