// Very small and very large balls, and very thin cells.
#include <cmath>

#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

StiffCase decades() {
  std::vector<CaseCell> cells;
  // Each ball inside a corner of space of the one before, its sites off the axis of view.
  for (int i = 0; i < 9; ++i) {
    const float radius = std::pow(10.0f, static_cast<float>(-i)), away = 2.0f * radius;
    cells.push_back(
        {{away, 0.3f * radius, 0.1f * radius}, radius, 2 / radius, kFaceToViewer, 0.3f, static_cast<uint32_t>(i)});
  }
  return {
      "sizes/decades",
      "radii from 1 to 1e-8 in one scene",
      "A ball of radius r at distance D is seen with an error of eps D / r of itself: those below eps D are at most "
      "single pixels, "
      "which the spread of their own edges covers.",
      foamOfCells(cells),
      {caseView({0, 0, -4}, {1, 0, 0}), caseView({0, 0, -4e-3}, {1e-3, 0, 0}), caseView({0, 0, -4e-6}, {1e-6, 0, 0})}};
}

StiffCase smallAndFar() {
  std::vector<CaseCell> cells;
  for (const CaseCell& cell : cloud(30, 33)) {
    cells.push_back(cell);
    cells.back().density *= 1.5f;
  }
  return {"sizes/small_and_far",
          "a scene 1e-3 units wide, 20 units away",
          "Distances along the ray err by eps D, and so does the length that a ray has in a cell: by D / r times more "
          "than its own "
          "roundings.",
          scaledFoam(foamOfCells(cells), 5e-4f),
          {caseView({0, 0, -20}, {0, 0, 0}, 32, 24, 3e-5)}};
}

StiffCase vanishing() {
  std::vector<CaseCell> cells = cloud(30, 31);
  for (size_t i = 0; i < cells.size(); i += 3) cells[i].radius = i % 2 == 0 ? 1e-20f : 1e-30f;
  return {"sizes/vanishing", "a third of the radii are 1e-20 and 1e-30",
          "Squares of such radii underflow to 0: the cells cut their neighbours as points do, and show nothing.",
          foamOfCells(cells), outsideViews()};
}

StiffCase larger() {
  std::vector<CaseCell> cells = cloud(24, 32);
  cells.push_back({{0.125f, 0, 40}, 44, 0.05f, kFaceToViewer, 5, 100});
  cells.push_back({{0, 900, 0}, 905, 0.02f, kFaceToViewer, 5, 101});
  return {
      "sizes/larger_than_scene", "two balls of 20 and 450 times the scene's size; the eye is inside both",
      "A plane towards a ball of radius R is off by eps R: the bound grows with the radius of the largest neighbour.",
      foamOfCells(cells), outsideViews()};
}

// Slabs between parallel radical planes, far thinner than the spacing of floats at their distance from the eye.
StiffCase thin() {
  std::vector<CaseCell> cells;
  for (int i = 0; i < 9; ++i) {
    const float thickness = std::pow(10.0f, static_cast<float>(-9 + i / 3)), x = static_cast<float>(i % 3 - 1) * 0.9f;
    const float y = static_cast<float>(i / 3 - 1) * 0.9f;
    for (int layer = -1; layer <= 1; ++layer) {
      cells.push_back({{x, y, thickness * static_cast<float>(layer)},
                       0.35f,
                       layer == 0 ? 1 / thickness : 0.5f,
                       kFaceToViewer,
                       layer == 0 ? 5 : 0.2f,
                       static_cast<uint32_t>(3 * i + layer + 1)});
    }
  }
  return {"sizes/thin",
          "slabs 1e-9, 1e-8 and 1e-7 thick with an optical depth of about 1",
          "At distance D both borders of a slab are off by eps D, more than it is thick: any opacity between 0 and "
          "that of a "
          "slab of eps D is right.",
          foamOfCells(cells),
          {caseView({0, 0, -3}, {0, 0, 0}), orthographicView({0, 0, -3}, {0, 0, 0}, 1.3)}};
}

// Balls that overlap in a lens thinner than float resolves.
StiffCase lens() {
  std::vector<CaseCell> cells;
  for (int i = 0; i < 8; ++i) {
    const float depth = std::pow(10.0f, static_cast<float>(-4 - i)), y = 0.3f * static_cast<float>(i - 4);
    cells.push_back({{0, y, 0}, 0.14f, 20, kFaceToViewer, 5, static_cast<uint32_t>(2 * i)});
    cells.push_back({{0.28f - depth, y, 0}, 0.14f, 20, kFaceToViewer, 5, static_cast<uint32_t>(2 * i + 1)});
  }
  return {"sizes/lens", "pairs of balls that overlap by 1e-4 to 1e-11",
          "The plane between them cuts off less than rounding, or nothing; it may not cut more.", foamOfCells(cells),
          outsideViews()};
}

}  // namespace

std::vector<StiffCase> sizeCases() { return {decades(), smallAndFar(), vanishing(), larger(), thin(), lens()}; }

}  // namespace froth
