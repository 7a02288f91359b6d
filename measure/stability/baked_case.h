// The bake of a stiff case by one preset.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "baker/input/foam_input.h"
#include "base/progress.h"
#include "foam/cell_graph.h"
#include "measure/stability/cases/stiff_case.h"
#include "reference/render/merged_foams.h"
#include "reference/render/reference.h"

namespace froth {

// An asset, and the foam that it holds relative to `base`, so that no float of it is larger than the scene.
struct BakedCase {
  AssetInput asset;
  glm::dvec3 base{0};
  Foam foam;
  CellGraph walkGraph;  // of `foam`, as the rows of the asset's chunks and their ghosts have it
  std::unique_ptr<ReferenceRenderer> reference;  // of `foam`
  std::vector<PlacedFoam> placed;  // the same, of several instances relative to `base`; empty: there is one
};

// The instances of a case in one image; empty: there is one. `renderer` draws its foam relative to `base`, which is
// where the images' origin lies.
std::vector<PlacedFoam> placeFoams(const StiffCase& stiff, const ReferenceRenderer& renderer, const glm::dvec3& base);

// Of `foam`, which the case holds or an importer made of it. `baked` stays where it is from then on.
Status bakeCase(const StiffCase& stiff, const Foam& foam, const std::string& preset, BakedCase& baked,
                const Progress& progress);

// What a view shows of it.
Result<RenderedImages> drawExactly(const BakedCase& baked, const View& view, const ReferenceOptions& options);

}  // namespace froth
