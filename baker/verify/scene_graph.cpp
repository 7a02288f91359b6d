#include "baker/verify/scene_graph.h"

#include <algorithm>
#include <span>

#include "format/checks.h"

namespace froth {
namespace {

std::vector<uint32_t> firstCells(const AssetContents& contents) {
  std::vector<uint32_t> first{0};
  for (const ChunkContents& chunk : contents.chunks) first.push_back(first.back() + chunk.cellCount);
  return first;
}

Status appendCells(const AssetContents& contents, uint32_t index, SceneGraph& scene) {
  const ChunkContents& chunk = contents.chunks[index];
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    glm::dvec3 site(chunk.sites[cell]);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<size_t>(axis);
      site[axis] += chunk.origin[a] - contents.chunks[0].origin[a];
    }
    const glm::vec3 rounded(site);
    if (glm::dvec3(rounded) != site) {
      return makeError(
          ErrorKind::kUnsupported,
          "chunk %u: cell %u is no float away from the origin of chunk 0; bake the scene again, or move the origins",
          index, cell);
    }
    scene.sites.push_back(rounded);
    scene.radii.push_back(chunk.radii[cell]);
  }
  return {};
}

// Ascending, as in a CellGraph.
void appendRow(const AssetContents& contents, const std::vector<uint32_t>& first, uint32_t index,
               std::span<const uint32_t> neighbours, CellGraph& graph) {
  const ChunkContents& chunk = contents.chunks[index];
  const auto begin = static_cast<std::ptrdiff_t>(graph.neighbours.size());
  for (const uint32_t neighbour : neighbours) {
    const bool isOwn = neighbour < chunk.cellCount;
    const CellRef ghost = isOwn ? 0 : chunk.ghostRefs[neighbour - chunk.cellCount];
    graph.neighbours.push_back(isOwn ? first[index] + neighbour
                                     : first[chunkOf(ghost, contents.localBits)] + localOf(ghost, contents.localBits));
  }
  std::sort(graph.neighbours.begin() + begin, graph.neighbours.end());
  graph.offsets.push_back(static_cast<uint32_t>(graph.neighbours.size()));
}

std::span<const uint32_t> rowOf(const ChunkContents& chunk, uint32_t cell) {
  const uint32_t begin = chunk.neighbourOffsets[cell];
  return std::span(chunk.neighbours).subspan(begin, chunk.neighbourOffsets[cell + 1] - begin);
}

}  // namespace

Result<SceneGraph> joinChunks(const AssetContents& contents, const Progress& progress) {
  const std::vector<uint32_t> first = firstCells(contents);
  uint64_t entries = 0;
  for (const ChunkContents& chunk : contents.chunks) entries += chunk.neighbours.size();
  if (entries > UINT32_MAX) {
    return makeError(ErrorKind::kUnsupported, "%llu neighbours in all chunks; at most %u can be checked at once",
                     static_cast<unsigned long long>(entries), UINT32_MAX);
  }
  SceneGraph scene;
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    if (Status status = appendCells(contents, index, scene); !status) return status.error();
  }
  if (!contents.hasWalkGraph) {
    Result<RegularTriangulation> made = triangulateWithin(0, scene.sites, scene.radii, progress);
    if (!made) return made.error();
    scene.triangulation = std::move(*made);
  } else {
    scene.triangulation.isHidden.assign(scene.sites.size(), 0);
    scene.triangulation.graph.offsets.push_back(0);
    for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
      for (uint32_t cell = 0; cell < contents.chunks[index].cellCount; ++cell) {
        appendRow(contents, first, index, rowOf(contents.chunks[index], cell), scene.triangulation.graph);
      }
    }
  }
  scene.alpha.isEmpty.assign(scene.sites.size(), 0);
  CellGraph& alpha = scene.alpha.graph;
  alpha.offsets.push_back(0);
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    const ChunkContents& chunk = contents.chunks[index];
    for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
      appendRow(contents, first, index, rowOf(chunk, cell).first(chunk.alphaCounts[cell]), alpha);
    }
    for (uint32_t cell = chunk.liveCount; cell < chunk.cellCount; ++cell) {
      const std::span<const uint32_t> row = neighboursOf(scene.triangulation.graph, first[index] + cell);
      alpha.neighbours.insert(alpha.neighbours.end(), row.begin(), row.end());
      alpha.offsets.push_back(static_cast<uint32_t>(alpha.neighbours.size()));
    }
  }
  return scene;
}

}  // namespace froth
