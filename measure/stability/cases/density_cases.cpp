// Densities and optical depths from nothing to opaque within a rounding.
#include <cmath>

#include <fmt/format.h>

#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

StiffCase withDensity(const std::string& name, const std::string& what, float density, const std::string& analysis) {
  std::vector<CaseCell> cells = cloud(36, 41);
  for (size_t i = 0; i < cells.size(); i += 2) cells[i].density = density;
  return {name, what, analysis, foamOfCells(cells), outsideViews()};
}

// Slabs of one optical depth each, seen straight on: sites far apart along x, so that each fills a column of the image.
StiffCase opticalDepths() {
  std::vector<CaseCell> cells;
  for (int i = 0; i <= 18; ++i) {
    const float density = std::pow(10.0f, static_cast<float>(i - 9)) / 0.2f;
    cells.push_back(
        {{0.21f * static_cast<float>(i - 9), 0, 0}, 0.1f, density, kFaceToViewer, 5, static_cast<uint32_t>(i)});
  }
  return {"density/optical_depth",
          "balls side by side with optical depths from 1e-9 to 1e9",
          "1 - exp(-x) keeps its relative precision through expm1 or its series; from x = 17 on it is 1 in float. "
          "Nothing is negative.",
          foamOfCells(cells),
          {caseView({0, 0, -3}, {0, 0, 0}, 48, 8, 0.12)}};
}

// The light of opaque cells must not be lost behind a veil, nor a veil behind them.
StiffCase veils() {
  std::vector<CaseCell> cells;
  for (int i = 0; i < 12; ++i) {
    const float density = i % 2 == 0 ? 1e-9f : 1e-5f;
    cells.push_back({{0, 0, 0.4f * static_cast<float>(i)},
                     0.9f,
                     i == 11 ? 1e9f : density,
                     kFaceToViewer,
                     5,
                     static_cast<uint32_t>(i)});
  }
  return {"density/veils", "eleven veils of 1e-9 and 1e-5 before an opaque wall",
          "Transmittance is a sum of logarithms: what each veil takes survives, where a product of (1 - alpha) would "
          "hold 1.",
          foamOfCells(cells), outsideViews()};
}

}  // namespace

std::vector<StiffCase> densityCases() {
  return {withDensity("density/zero", "half of the cells have density 0", 0,
                      "Empty cells cut their neighbours and show nothing; no -0, no NaN."),
          withDensity("density/1e-12", "half of the cells have density 1e-12", 1e-12f,
                      "They add 1e-12 of their colour; what a preset rounds to 0 is as far off."),
          withDensity(
              "density/1e8", "half of the cells have density 1e8", 1e8f,
              "Opaque at any thickness above 1e-8: the image jumps where a ray grazes such a cell within rounding."),
          opticalDepths(), veils()};
}

}  // namespace froth
