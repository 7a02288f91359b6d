#include "baker/bake/attribute_errors.h"

namespace froth {

std::vector<AttributeError> AttributeErrors::list() const {
  const auto entry = [](const char* name, const char* unit, const ErrorSum& sum) {
    return AttributeError{name, unit, sum.weight > 0 ? std::sqrt(sum.squares / sum.weight) : 0, sum.max};
  };
  return {entry("sites", "scene units", sites),         entry("radii", "relative", radii),
          entry("densities", "relative", densities),    entry("normals", "radians", normals),
          entry("detail sites", "radius", detailSites), entry("detail heights", "radius", detailHeights),
          entry("colours", "display-coded", colours)};
}

}  // namespace froth
