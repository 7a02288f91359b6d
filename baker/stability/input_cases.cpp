// What a checkpoint may hold that no foam can: each is written as one and imported.
#include "baker/stability/case_parts.h"

namespace froth {
namespace {

StiffCase withQuaternion(const std::string& name, const std::string& what, float length, const std::string& refusal) {
  Foam foam = foamOfCells(cloud(32, 81));
  for (size_t i = 0; i < foam.orientations.size(); i += 5) foam.orientations[i] *= length;
  StiffCase stiff{name, what,
                  refusal.empty() ? "The importer normalises in double, where the square of 1e-20 is a number like any other."
                                  : "No direction follows from it; the importer says which cell.",
                  std::move(foam), outsideViews()};
  stiff.isImported = true;
  stiff.refusal = refusal;
  return stiff;
}

}  // namespace

std::vector<StiffCase> inputCases() {
  return {withQuaternion("input/quaternion_0", "a fifth of the quaternions are 0", 0, "the quaternion of cell 0 has length 0"),
          withQuaternion("input/quaternion_1e-20", "a fifth of the quaternions have the length 1e-20", 1e-20f, "")};
}

}  // namespace froth
