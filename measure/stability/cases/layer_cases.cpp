// Assets of which the first layers alone are loaded: complete, coarser scenes.
#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

StiffCase ofLayers(const std::string& name, const std::string& what, uint32_t layers, const Foam& foam) {
  StiffCase stiff{name, what, "The image is that of the foam which these layers hold, and no harder.", foam,
                  outsideViews()};
  stiff.views.push_back(orthographicView({0, 0, 0}, {0.3, 0.2, 1}, 1.2));
  stiff.layers = layers;
  return stiff;
}

// Deep dents, and colours far beyond white.
Foam deepAndBright() {
  Foam foam = foamOfCells(cloud(40, 96));
  for (size_t i = 0; i < foam.detailHeights.size(); ++i) foam.detailHeights[i] *= i % 7 == 0 ? -8.0f : 2.0f;
  for (glm::vec3& colour : foam.lobeColours) colour *= 20.0f;
  return foam;
}

}  // namespace

std::vector<StiffCase> layerCases() {
  const Foam foam = foamOfCells(cloud(40, 95));
  std::vector<StiffCase> cases = {
      ofLayers("layers/one_colour", "one colour and height per cell", 1, foam),
      ofLayers("layers/no_view_dependence", "detail sites without lobes", 2, foam),
      ofLayers("layers/one_colour_bright", "one colour of cells that are deeply dented and beyond white", 1,
               deepAndBright()),
      ofLayers("layers/no_view_dependence_bright", "detail sites of the same", 2, deepAndBright())};
  for (StiffCase& stiff : cases) stiff.chunkCells = 16;  // layers are stored chunk by chunk
  return cases;
}

}  // namespace froth
