// Numbers at the edge of float: rays in a radical plane, wide lenses, huge balls.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "measure/stability/cases/case_parts.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;

// Raster and walk, from walks that start anywhere, within `most` of the reference.
void expectReference(const Foam& foam, const std::vector<View>& views, double most) {
  for (const View& view : views) {
    Stage stage(bakeForTest(foam), {view.width, view.height}, lensContext(), 0, kLenses);
    const RenderedImages expected = renderReference(foam, view);
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      const Frame drawn = stage.draw(method, view);
      EXPECT_LE(compareImages(drawn.colour, expected.colour)->maxError, most)
          << (method == Method::kWalk ? "walk" : "raster");
      EXPECT_LE(compareImages(drawn.alpha, expected.alpha)->maxError, most)
          << (method == Method::kWalk ? "walk" : "raster");
    }
  }
}

std::vector<View> viewsFrom(const glm::dvec3& eye) {
  const glm::dvec3 target = eye + glm::dvec3(0, 0, 1);
  return {caseView(eye, target, 25, 25, 0.5), orthographicView(eye, target, 1.1, 25, 25)};
}

//   (  |  )
//   ( 0|1 )
//   (  |  )
//      ^ the middle column of rays
TEST(RaysInAPlane, ShowOneOfItsTwoCells) {
  for (const bool isSwapped : {false, true}) {
    std::vector<CaseCell> cells = {{{-0.25f, 0, 0}, 0.5f, 1.5f, kFaceToViewer, 5, 1},
                                   {{0.25f, 0, 0}, 0.5f, 1.5f, kFaceToViewer, 5, 2}};
    if (isSwapped) std::swap(cells[0], cells[1]);
    const Foam foam = foamOfCells(cells);
    for (const View& view : viewsFrom({0, 0, -2})) {
      const double chord = 2 * std::sqrt(0.25 - 0.0625);
      const RenderedImages images = renderReference(foam, view);
      EXPECT_NEAR(*images.alpha.pixel(12, 12), 1 - std::exp(-1.5 * chord), 1e-6);
      EXPECT_EQ(images.cells[12 * 25 + 12], isSwapped ? 1u : 0u) << "the cell of smaller x";
    }
    expectReference(foam, viewsFrom({0, 0, -2}), 1e-3);
  }
}

// Four layers of four cells, whose planes meet along the z axis.
Foam layersOfFour() {
  std::vector<CaseCell> cells;
  for (int z = 0; z < 4; ++z) {
    for (const float x : {0.25f, -0.25f}) {
      for (const float y : {0.25f, -0.25f}) {
        cells.push_back(
            {{x, y, 0.5f * static_cast<float>(z)}, 0.375f, 2, kFaceToViewer, 5, static_cast<uint32_t>(cells.size())});
      }
    }
  }
  return foamOfCells(cells);
}

TEST(RaysInAPlane, GoOnInTheCellsOfTheFirstSitesBeyondEdges) {
  for (const double y : {0.0, 0.125}) expectReference(layersOfFour(), viewsFrom({0, y, -2}), 1e-3);
}

// GPUs round the directions of rays out of the plane by less than the orders of sites tell apart.
TEST(RaysInAPlane, WalkAsTheyRasterizeThoughRoundingTurnsThem) {
  const Foam foam = layersOfFour();
  for (View view : viewsFrom({0, 0, -2})) {
    for (const double turn : {-1e-17, 1e-17}) {
      view.worldFromCamera[2] = turn;  // x of the forward axis
      Stage stage(bakeForTest(foam), {view.width, view.height}, lensContext(), 0, kLenses);
      const Frame raster = stage.draw(Method::kRaster, view), walk = stage.draw(Method::kWalk, view);
      EXPECT_LE(compareImages(walk.colour, raster.colour)->maxError, 1e-3) << turn;
    }
  }
}

// The rays of a lens of nearly half a turn are sums of vectors far longer than the middle one.
TEST(WideLenses, LoseNothingOfTheirMiddleRays) {
  const Foam foam = foamOfCells({{{0.3f, -0.2f, 20000.0f}, 1, 1, kFaceToViewer, 5, 1}});
  View view = caseView({0, 0, 0}, glm::dvec3(0.3, -0.2, 20000), 9, 5, 80);
  expectReference(foam, {view}, 2e-3);
}

TEST(HugeBalls, AreCutByTheirFaces) {
  for (const float height : {-2.0f, 0.0f}) {
    const Foam foam = foamOfCells(
        {{{0, 0, 0}, 2e14f, 1, glm::vec4(0.9898772f, -0.12923546f, -0.0402591f, -0.042666964f), height, 1}});
    expectReference(foam, {orthographicView({0, 0, -2.5e14}, {0, 0, 0}, 1e14, 8, 8)}, 2e-3);
  }
}

}  // namespace
}  // namespace froth::test
