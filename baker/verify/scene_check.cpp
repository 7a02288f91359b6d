#include "baker/verify/scene_check.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "baker/bake/solid_balls.h"
#include "baker/graph/diagram_check.h"
#include "baker/lod/cut.h"
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

// Adds samples of the diagram of an asset without levels to what was found.
Status checkDiagram(const AssetContents& contents, const Progress& progress, ValidityReport& found) {
  const Result<SceneGraph> scene = joinChunks(contents, progress);
  if (!scene) return scene.error();
  found.cells += scene->sites.size();
  found.walkPairs += scene->triangulation.graph.neighbours.size() / 2;
  found.alphaPairs += scene->alpha.graph.neighbours.size() / 2;
  if (!sampleDiagram(scene->sites, scene->radii, scene->triangulation, scene->alpha, kSeed, progress, found)) {
    return stoppedOnRequest("verify");
  }
  if (found.faults.empty()) return {};
  return makeError(ErrorKind::kBadInput, "graphs: %s; bake the scene again", found.faults.front().c_str());
}

// The finest level, the floor, and halfway: the coarser half of the groups refined.
Status checkLevels(const AssetContents& contents, const Progress& progress, ValidityReport& found) {
  const size_t groups = contents.groups.size();
  std::vector<uint8_t> isRefined(groups, 1);
  const auto check = [&]() -> Status {
    const Result<AssetContents> cut = contentsOfCut(contents, isRefined);
    if (!cut) return cut.error();
    return checkDiagram(*cut, progress, found);
  };
  if (Status status = check(); !status) return status;
  std::vector<double> errors;
  for (const LevelGroup& group : contents.groups) errors.push_back(group.error);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(groups / 2), errors.end());
  const double median = errors[groups / 2];
  for (size_t group = 0; group < groups; ++group) isRefined[group] = contents.groups[group].error >= median;
  if (Status status = check(); !status) return status;
  std::fill(isRefined.begin(), isRefined.end(), uint8_t{0});
  return check();
}

}  // namespace

Result<ValidityReport> checkScene(const AssetContents& contents, const Progress& progress) {
  ValidityReport found;
  Status status =
      contents.levels.empty() ? checkDiagram(contents, progress, found) : checkLevels(contents, progress, found);
  if (!status) return status.error();
  if (status = checkSolidBalls(contents); !status) return status.error();
  return found;
}

}  // namespace froth
