// The bake of a stiff case by one preset.
#pragma once

#include <memory>
#include <string>

#include "baker/graph/graph.h"
#include "baker/progress.h"
#include "baker/reference/reference.h"
#include "baker/tool/foam_input.h"

namespace froth {

// An asset, and the foam that it holds relative to `base`, so that no float of it is larger than the scene.
struct BakedCase {
  AssetInput asset;
  glm::dvec3 base{0};
  Foam foam;
  CellGraph walkGraph;  // of `foam`, as the rows of the asset's chunks and their ghosts have it
  std::unique_ptr<ReferenceRenderer> reference;  // of `foam`
};

// chunkCells: most cells of a chunk; 0: as the preset has it. `baked` stays where it is from then on.
Status bakeCase(const Foam& foam, const std::string& preset, uint32_t chunkCells, BakedCase& baked, const Progress& progress);

}  // namespace froth
