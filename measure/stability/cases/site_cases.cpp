// Sites in special position: what triangulations and radical planes find hard.
#include <cmath>

#include "base/counter_random.h"
#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

StiffCase duplicates(bool isSameRadius) {
  std::vector<CaseCell> cells = cloud(36, 11);
  for (uint32_t i = 0; i < 12; ++i) {
    CaseCell twin = cells[i];
    if (!isSameRadius) twin.radius *= i % 2 == 0 ? 1.25f : 0.75f;
    twin.look += 1000;
    cells.push_back(twin);
  }
  const std::string name = isSameRadius ? "sites/duplicate_equal" : "sites/duplicate_different";
  return {
      name,
      isSameRadius ? "a third of the sites twice, with equal radii" : "a third of the sites twice, with other radii",
      "Of cells at one site only the largest, then the first, exists: a choice, not a rounding. The rest is as well "
      "conditioned as without the duplicates.",
      foamOfCells(cells), outsideViews()};
}

StiffCase flat() {
  std::vector<CaseCell> cells;
  for (int y = -3; y <= 3; ++y) {
    for (int x = -3; x <= 3; ++x) {
      CaseCell cell{{0.3f * x, 0.3f * y, 0}, 0.25f, 8, kFaceToViewer, 0.3f, static_cast<uint32_t>(50 + 7 * y + x)};
      cell.site.x += 0.07f * std::sin(5.0f * x + 3.0f * y);
      cells.push_back(cell);
    }
  }
  return {"sites/coplanar",
          "all sites in the plane z = 0: a triangulation of two dimensions",
          "Radical planes stand upright on the plane of sites, well apart. Rays in that plane meet as many of them as "
          "others.",
          foamOfCells(cells),
          {caseView({0, 0, -3}, {0, 0, 0}), caseView({3, 0, 0}, {0, 0, 0})}};
}

StiffCase line() {
  std::vector<CaseCell> cells;
  for (int i = -8; i <= 8; ++i) {
    cells.push_back({{0.2f * i, 0, 0}, 0.22f, 8, kFaceToViewer, 0.3f, static_cast<uint32_t>(20 + i)});
  }
  return {
      "sites/collinear",
      "all sites on one line: a triangulation of one dimension",
      "All radical planes are parallel; a ray along them meets none, one across meets all at well separated distances.",
      foamOfCells(cells),
      {caseView({0, 0, -2}, {0, 0, 0}), caseView({-3, 0, 0}, {0, 0, 0}, 33, 25)}};
}

// The 24 permutations of (+-1, +-2, +-3) / 4 that rotate a cube, and their mirror images lie on one sphere, exactly in
// float.
StiffCase sphere() {
  std::vector<CaseCell> cells;
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int order = 0; order < 6; ++order) {
    for (int signs = 0; signs < 8; ++signs) {
      glm::vec3 site;
      for (int axis = 0; axis < 3; ++axis) {
        site[orders[order][axis]] = static_cast<float>((signs >> axis & 1) != 0 ? axis + 1 : -axis - 1) / 4;
      }
      cells.push_back({site, 0.4f, 8, kFaceToViewer, 0.3f, static_cast<uint32_t>(cells.size())});
    }
  }
  return {"sites/cospherical", "48 sites exactly on one sphere: all power cells meet in its centre",
          "The vertex of 48 cells may fall into any of many tetrahedra, all of which give the same cells but for "
          "slivers of "
          "rounding size.",
          foamOfCells(cells), outsideViews()};
}

StiffCase grid(const std::string& name, const std::string& what, double jitter) {
  const CounterRandom random(5, Purpose::kSite);
  std::vector<CaseCell> cells;
  for (int z = -2; z <= 2; ++z) {
    for (int y = -2; y <= 2; ++y) {
      for (int x = -2; x <= 2; ++x) {
        const auto i = static_cast<uint32_t>(cells.size());
        const glm::dvec3 noise(random.uniform(3 * i, -1, 1), random.uniform(3 * i + 1, -1, 1),
                               random.uniform(3 * i + 2, -1, 1));
        const glm::vec3 site(0.375 * glm::dvec3(x, y, z) + jitter * noise);
        cells.push_back({site, 0.3125f, i % 5 == 4 ? 0.0f : 6.0f, kFaceToViewer, 0.3f, i});
      }
    }
  }
  // The second looks straight along the grid's planes, with a column of pixels on each side of them.
  return {name,
          what,
          "Eight cells meet in each vertex, and four along each edge, up to the jitter: edges of length 0 or of "
          "rounding size come "
          "and go, with cells behind them that no pixel can tell apart.",
          foamOfCells(cells),
          {caseView({0.4, -0.7, -3}, {0, 0, 0}), orthographicView({0, 0, -3}, {0, 0, 0}, 0.75)}};
}

// A cell in the middle of a sphere of sites, each of which is its neighbour.
Foam hubOf(int spokes) {
  const double golden = glm::pi<double>() * (3 - std::sqrt(5.0));
  const float reach = 5.6f / std::sqrt(static_cast<float>(spokes));  // some 30 spokes overlap each
  std::vector<CaseCell> cells = {{{0, 0, 0}, 1 - reach / 4, 1.5f, kFaceToViewer, 5, 0}};
  for (int i = 0; i < spokes; ++i) {
    const double z = 1 - (2 * i + 1.0) / spokes, radius = std::sqrt(1 - z * z);
    const glm::vec3 site(radius * std::cos(golden * i), radius * std::sin(golden * i), z);
    cells.push_back({site, reach, i % 3 == 0 ? 30.0f : 0.0f, kFaceToViewer, 5, static_cast<uint32_t>(i % 97)});
  }
  return foamOfCells(cells);
}

constexpr const char* kHubAnalysis =
    "Each plane is rounded by itself, so the hub's cell is off by rounding as any other's; only the number of planes "
    "grows.";

// Single rays: Mesa's driver for CPUs ends all loops of a group of rays after 65,535 rounds in sum, which is three
// times through the row of the hub (the view's status tells of it).
StiffCase hub() {
  std::vector<View> views;
  for (const glm::dvec3& eye : {glm::dvec3(0, 0, -2.5), glm::dvec3(1.7, -1.2, 1.4), glm::dvec3(0.1, -0.2, 0.3)}) {
    views.push_back(caseView(eye, {0.1, 0.15, 0.05}, 1, 1));
  }
  return {"sites/hub", "one cell with 20,000 neighbours, by single rays", kHubAnalysis, hubOf(20000), std::move(views)};
}

StiffCase smallHub() {
  return {"sites/hub_3000",
          "one cell with 3,000 neighbours",
          kHubAnalysis,
          hubOf(3000),
          {caseView({0, 0, -2.5}, {0, 0, 0}, 24, 16)}};
}

StiffCase hidden() {
  std::vector<CaseCell> cells = cloud(42, 12);
  const size_t visible = cells.size();
  for (uint32_t i = 0; i < 18; ++i) {
    CaseCell cell = cells[i % visible];
    cell.site += glm::vec3(0.03125f, 0.015625f, -0.03125f);
    cell.radius = 0.03125f;  // its ball lies deep in that cell's, whose power is smaller everywhere
    cell.look += 500;
    cells.push_back(cell);
  }
  return {"sites/hidden", "30 % of the sites have no power cell",
          "What is hidden takes no part; the planes of the others do not know of it.", foamOfCells(cells),
          outsideViews()};
}

}  // namespace

std::vector<StiffCase> siteCases() {
  return {duplicates(true),
          duplicates(false),
          flat(),
          line(),
          sphere(),
          grid("sites/grid", "an exact grid", 0),
          grid("sites/grid_1e-6", "a grid, each coordinate off by up to 1e-6", 1e-6),
          grid("sites/grid_1e-9", "a grid, each coordinate off by up to 1e-9 (in float: those that are 0)", 1e-9),
          hub(),
          smallHub(),
          hidden()};
}

}  // namespace froth
