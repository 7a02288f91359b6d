// Images and lenses at their limits.
#include <cmath>

#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

StiffCase seen(const std::string& name, const std::string& what, const std::string& analysis, std::vector<View> views) {
  return {name, what, analysis, foamOfCells(cloud(40, 71)), std::move(views)};
}

View fisheye(uint32_t size) {
  View view = caseView({0.1, 0.2, -0.3}, {0, 0, 1}, size, size);
  view.lens.kind = LensKind::kFisheye;
  view.fx = view.fy = size / (2 * glm::pi<double>());
  return view;
}

View around() {
  View view = caseView({0.1, 0.2, -0.3}, {0, 0, 1}, 48, 24);
  view.lens.kind = LensKind::kEquirectangular;
  view.fx = view.fy = 24 / glm::pi<double>();
  return view;
}

// Six tiles of unequal lists, some of them empty, over five chunks whose rows name ghosts.
StiffCase inManyTiles() {
  StiffCase tiles{"views/many_tiles",
                  "300 cells of several chunks over six tiles",
                  "As any other: which tile or chunk holds a cell is no part of the formulas.",
                  foamOfCells(cloud(300, 72)),
                  {caseView({1.5, -1, -3.5}, {0.6, 0, 0}, 96, 64, 0.6)}};
  tiles.chunkCells = 64;
  return tiles;
}

// Moved by shares of a pixel as engines do that gather frames, and by some pixels.
StiffCase jittered(const std::string& name, const glm::vec2& jitter) {
  StiffCase stiff =
      seen(name, "images whose lens is moved by jitter, and moved back by its centre",
           "Centre and jitter are added in double: as any other.",
           {caseView({0, 0, -3}, {0, 0, 0}), orthographicView({0, 0, 0}, {0.3, 0.2, 1}, 1.2), fisheye(32)});
  stiff.jitter = jitter;
  return stiff;
}

}  // namespace

std::vector<StiffCase> viewCases() {
  const double degree = glm::pi<double>() / 180;
  return {seen("views/1_degree", "a field of view of 1 degree from 100 units away",
               "Neighbouring rays differ by 1e-3 of the scene: errors of eps D are 1e-5 of it.",
               {caseView({0, 0, -100}, {0, 0, 0}, 32, 24, std::tan(0.5 * degree))}),
          seen("views/179_degrees", "a field of view of 179 degrees",
               "Rays at the border are normalised from vectors of length 100; nothing is close to a limit.",
               {caseView({0.1, 0.2, -0.3}, {0, 0, 1}, 32, 24, std::tan(89.5 * degree)),
                caseView({0, 0, -1.5}, {0, 0, 0}, 32, 24, std::tan(89.5 * degree))}),
          seen("views/1x1", "an image of one pixel", "As any other.", {caseView({0, 0, -3}, {0, 0, 0}, 1, 1)}),
          seen("views/16384x1", "an image of 16384 x 1 pixels", "As any other.",
               {caseView({0, 0, -3}, {0, 0, 0}, 16384, 1, 0.5 / 8192)}),
          seen("views/all_around", "a full fisheye and a panorama from within",
               "Directions behind and at the poles are as good as others.", {fisheye(32), around()}),
          seen("views/parallel", "an orthographic view from within, in the middle of cells",
               "Rays begin on a plane through cells; what is behind it is not seen.",
               {orthographicView({0, 0, 0}, {0.3, 0.2, 1}, 1.2)}),
          jittered("views/jitter", {0.375f, -0.25f}),
          jittered("views/jitter_of_pixels", {-5.4375f, 3.8125f}),
          inManyTiles()};
}

}  // namespace froth
