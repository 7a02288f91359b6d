#include "baker/verify/level_scene.h"

#include <vector>

#include "format/levels.h"

namespace froth {

AssetContents sceneOfLevel(const AssetContents& contents, uint32_t level) {
  AssetContents scene;
  scene.detailCount = contents.detailCount;
  scene.lobeCount = contents.lobeCount;
  scene.localBits = contents.localBits;
  scene.hasWalkGraph = contents.hasWalkGraph;
  scene.detailSharpness = contents.detailSharpness;
  scene.nearRatio = contents.nearRatio;
  scene.nearDepth = contents.nearDepth;
  scene.quantization = contents.quantization;
  scene.hasStartView = contents.hasStartView;
  scene.startView = contents.startView;
  scene.flightPath = contents.flightPath;
  std::vector<CellRef> cellOfBorder(contents.borderCount);
  for (size_t i = 0; i < contents.chunks.size(); ++i) {
    if (!isInLevel(contents.levels[i], level)) continue;
    const ChunkContents& chunk = contents.chunks[i];
    const uint64_t first = uint64_t{scene.chunks.size()} << contents.localBits;
    for (size_t border = 0; border < chunk.borderCells.size(); ++border) {
      cellOfBorder[chunk.borderNumbers[border]] = static_cast<CellRef>(first | chunk.borderCells[border]);
    }
    scene.chunks.push_back(chunk);
  }
  for (ChunkContents& chunk : scene.chunks) {
    for (CellRef& ghost : chunk.ghostRefs) ghost = cellOfBorder[ghost];
    chunk.borderCells.clear();
    chunk.borderNumbers.clear();
  }
  return scene;
}

}  // namespace froth
