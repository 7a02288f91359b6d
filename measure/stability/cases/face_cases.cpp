// Faces seen edge-on, and from within their plane.
#include <cmath>

#include <fmt/format.h>

#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

// Faces whose planes hold the direction of all rays, but for the tilt.
StiffCase edgeOn(const std::string& name, double tilt, float height) {
  // The normal is +x, turned about y by the tilt.
  const glm::vec4 turned(std::cos(tilt / 2), 0, std::sin(tilt / 2), 0);
  std::vector<CaseCell> cells;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      cells.push_back({{0.8f * static_cast<float>(x), 0.8f * static_cast<float>(y), 0},
                       0.5f,
                       8,
                       turned,
                       height,
                       static_cast<uint32_t>(3 * y + x + 4)});
    }
  }
  return {name,
          fmt::format("parallel rays in the planes of the faces, n . d = {:.0e}", tilt),
          "The face is met at a distance like 1 / (n . d), beyond either end of the ball: the whole chord counts or "
          "nothing, and the "
          "image jumps only for rays within rounding of the displaced face.",
          foamOfCells(cells),
          {orthographicView({0, 0, -3}, {0, 0, 0}, 1.3, 33, 25), orthographicView({0, 0, -3}, {0, 0, 0}, 1.3)}};
}

StiffCase throughEye() {
  std::vector<CaseCell> cells;
  for (int y = -2; y <= 2; ++y) {
    cells.push_back({{0, 0.5f * static_cast<float>(y), 0}, 0.4f, 8, kFaceSideways, 0, static_cast<uint32_t>(y + 2)});
  }
  Foam foam = foamOfCells(cells);
  for (float& height : foam.detailHeights) height = 0;
  return {"faces/through_eye",
          "the eye lies in the plane of every face, without displacement",
          "n . (p - o) and n . d are both roundings for rays in the plane: their quotient is anything, so such a pixel "
          "may show the "
          "face from either side.",
          foam,
          {caseView({0, 0.25, -3}, {0, 0.25, 0}, 33, 25), caseView({0, 0, -0.5}, {0, 0.5, 0}, 33, 25)}};
}

}  // namespace

std::vector<StiffCase> faceCases() {
  return {edgeOn("faces/edge_on", 0, 0.2f), edgeOn("faces/edge_on_plus", 1e-8, 0.2f),
          edgeOn("faces/edge_on_minus", -1e-8, 0.2f), edgeOn("faces/edge_on_flat", 0, 0.0f), throughEye()};
}

}  // namespace froth
