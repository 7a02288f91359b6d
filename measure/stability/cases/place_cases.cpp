// Scenes far from the world's origin, and in small and large units.
#include <cmath>

#include <fmt/format.h>

#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

// Sites are multiples of what float resolves at the distance, so that the scene itself is the same wherever it lies.
StiffCase moved(const std::string& name, float distance, float scale) {
  const glm::vec3 by(distance, -distance, distance);
  const Foam foam = movedFoam(scaledFoam(foamOfCells(cloud(40, 21, 1.0f / 8)), scale), by);
  const glm::dvec3 centre(by), front(0.3, 0.2, -3.5), corner(2.4, -1.5, 1.8);
  return {name,
          fmt::format("a scene of {} units, {:.0e} units from the origin", 2 * scale, distance),
          "The eye is subtracted from sites in double or in two floats; what is left is as large as the scene, and so "
          "are the "
          "errors: they do not grow with the distance.",
          foam,
          {caseView(centre + double{scale} * front, centre), caseView(centre + double{scale} * corner, centre)}};
}

StiffCase inUnits(const std::string& name, float unit) {
  std::vector<View> views = outsideViews(3.5 * unit);
  return {name, fmt::format("a scene in units of {:.0e}", 1 / unit),
          "All formulas are homogeneous in length; no threshold may have a unit.",
          scaledFoam(foamOfCells(cloud(40, 22)), unit), std::move(views)};
}

}  // namespace

std::vector<StiffCase> placeCases() {
  return {moved("place/1e3", 1e3f, 1), moved("place/1e6", 1e6f, 1), moved("place/1e9", 1e9f, 512),
          inUnits("place/unit_1e-6", 1e6f), inUnits("place/unit_1e6", 1e-6f)};
}

}  // namespace froth
