// The cases that transform a user's foam.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "foam/cell_graph.h"
#include "measure/stability/cases/stiff_case.h"
#include "reference/camera/view_rays.h"
#include "reference/render/reference_state.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr uint32_t kMostWidth = 160;  // [pixels]

std::vector<View> smallViews(const std::vector<View>& views) {
  std::vector<View> small;
  for (const View& view : views) {
    const double scale = std::min(1.0, double{kMostWidth} / view.width);
    const auto scaled = [&](uint32_t side) { return std::max(1u, static_cast<uint32_t>(std::lround(side * scale))); };
    small.push_back(resizeView(view, scaled(view.width), scaled(view.height)));
    small.back().nearRatio = view.nearRatio.value_or(4);
    small.back().nearDepth = view.nearDepth.value_or(0);
  }
  return small;
}

void moveEye(const glm::dvec3& eye, View& view) {
  for (int row = 0; row < 3; ++row) view.worldFromCamera[4 * static_cast<size_t>(row) + 3] = eye[row];
}

// ---- The scene elsewhere, and in other units

StiffCase placedFarAway(const Foam& foam, const std::vector<View>& views, double distance) {
  StiffCase moved;
  moved.name = fmt::format("foam/placed_{:.0e}_away", distance);
  moved.what = fmt::format("the asset and the eyes {:g} units from the origin", distance);
  moved.analysis = "placement and eye are subtracted in double, so the image is that at the origin";
  moved.foam = foam;
  moved.views = views;
  moved.moved = {distance, -distance, distance};
  return moved;
}

StiffCase savedFarAway(const Foam& foam, const std::vector<View>& views, double distance) {
  StiffCase moved;
  moved.name = fmt::format("foam/saved_{:.0e}_away", distance);
  moved.what = fmt::format("sites saved as floats {:g} units from the origin", distance);
  moved.analysis =
      "rounding moves the sites before anything is drawn; what is left of the foam is drawn as well as at the origin";
  moved.foam = foam;
  moved.views = views;
  for (glm::vec3& site : moved.foam.sites) site = glm::dvec3(site) + distance;
  for (View& view : moved.views) moveEye(eyeOf(view) + distance, view);
  return moved;
}

StiffCase inUnits(const Foam& foam, const std::vector<View>& views, double unit) {
  StiffCase scaled;
  scaled.name = fmt::format("foam/units_{:.0e}", unit);
  scaled.what = fmt::format("every length times {:g}", unit);
  scaled.analysis = "lengths over lengths and densities times lengths are what they were: no bound grows";
  scaled.foam = foam;
  scaled.views = views;
  for (glm::vec3& site : scaled.foam.sites) site = glm::dvec3(site) * unit;
  for (float& radius : scaled.foam.radii) radius = static_cast<float>(radius * unit);
  for (float& density : scaled.foam.densities) density = static_cast<float>(density / unit);
  for (View& view : scaled.views) {
    moveEye(eyeOf(view) * unit, view);
    view.nearDepth = *view.nearDepth * unit;
    if (view.lens.kind == LensKind::kOrthographic) view.fx /= unit, view.fy /= unit;
  }
  return scaled;
}

// ---- Eyes where formulas divide by zero

// The cell that the first view sees nearest to its middle; cell 0 if it sees none.
uint32_t findCellInMiddle(const ReferenceRenderer& renderer, const View& view) {
  ReferenceOptions options;
  options.nearRatio = *view.nearRatio;
  options.nearDepth = *view.nearDepth;
  const Result<RenderedImages> images = renderer.render(view, options);
  uint32_t nearest = 0;
  double least = INFINITY;
  for (uint32_t pixel = 0; images && pixel < images->cells.size(); ++pixel) {
    const double x = pixel % view.width + 0.5 - view.width / 2.0, y = pixel / view.width + 0.5 - view.height / 2.0;
    if (images->cells[pixel] == UINT32_MAX || x * x + y * y >= least) continue;
    least = x * x + y * y;
    nearest = images->cells[pixel];
  }
  return nearest;
}

// A radical plane of a cell, from its site.
struct LocalPlane {
  glm::dvec3 toNeighbour;
  double offset;
  double distance() const { return std::abs(offset) / glm::length(toNeighbour); }
};

// Nearest first; those of coinciding sites are none.
std::vector<LocalPlane> planesOf(const Foam& foam, const CellGraph& pairs, uint32_t cell) {
  std::vector<LocalPlane> planes;
  for (const uint32_t other : neighboursOf(pairs, cell)) {
    const glm::dvec3 toNeighbour = glm::dvec3(foam.sites[other]) - glm::dvec3(foam.sites[cell]);
    if (toNeighbour == glm::dvec3(0)) continue;
    planes.push_back(
        {toNeighbour, foam::radicalOffset(toNeighbour, double{foam.radii[cell]}, double{foam.radii[other]})});
  }
  std::stable_sort(planes.begin(), planes.end(),
                   [](const LocalPlane& a, const LocalPlane& b) { return a.distance() < b.distance(); });
  return planes;
}

// A corner of the bounded cell, from its site: where three of its nearest planes meet, on the cell's side of all.
std::optional<glm::dvec3> findVertex(const std::vector<LocalPlane>& planes, double radius) {
  const size_t most = std::min<size_t>(planes.size(), 16);
  const auto isOfCell = [&](const glm::dvec3& point, size_t i, size_t j, size_t k) {
    if (!(glm::length(point) <= radius)) return false;
    for (size_t p = 0; p < planes.size(); ++p) {
      if (p != i && p != j && p != k && glm::dot(planes[p].toNeighbour, point) > planes[p].offset) return false;
    }
    return true;
  };
  for (size_t k = 2; k < most; ++k) {
    for (size_t j = 1; j < k; ++j) {
      for (size_t i = 0; i < j; ++i) {
        const glm::dmat3 rows =
            glm::transpose(glm::dmat3(planes[i].toNeighbour, planes[j].toNeighbour, planes[k].toNeighbour));
        if (glm::determinant(rows) == 0) continue;
        const glm::dvec3 point = glm::inverse(rows) * glm::dvec3(planes[i].offset, planes[j].offset, planes[k].offset);
        if (isOfCell(point, i, j, k)) return point;
      }
    }
  }
  return std::nullopt;
}

void appendEyeCases(const Foam& foam, const std::vector<View>& views, std::vector<StiffCase>& cases) {
  const ReferenceRenderer renderer(foam);
  const uint32_t cell = findCellInMiddle(renderer, views[0]);
  const glm::dvec3 site(foam.sites[cell]);
  const double radius = foam.radii[cell];
  const auto append = [&](const char* name, const char* what, const glm::dvec3& eye) {
    StiffCase placed;
    placed.name = fmt::format("foam/eye_on_{}", name);
    placed.what = fmt::format("the eye on {} of cell {}, without near tests", what, cell);
    placed.analysis = "quantities that vanish at the eye take either sign within rounding";
    placed.foam = foam;
    placed.views = {views[0]};
    moveEye(eye, placed.views[0]);
    placed.views[0].nearRatio = placed.views[0].nearDepth = 0;
    cases.push_back(std::move(placed));
  };
  append("site", "the site", site);
  append("sphere", "the sphere", site - radius * forwardOf(views[0]));
  const std::vector<LocalPlane> planes = planesOf(foam, renderer.state().cechPairs, cell);
  if (planes.empty()) return;
  const LocalPlane& nearest = planes[0];
  const glm::dvec3 foot = nearest.toNeighbour * (nearest.offset / glm::dot(nearest.toNeighbour, nearest.toNeighbour));
  append("radical_plane", "the nearest radical plane", site + foot);
  if (const auto vertex = findVertex(planes, radius)) append("vertex", "a vertex", site + *vertex);
}

}  // namespace

std::vector<StiffCase> casesOfFoam(const Foam& foam, const std::vector<View>& views) {
  const std::vector<View> small = smallViews(views);
  std::vector<StiffCase> cases;
  for (const double distance : {1e3, 1e6, 1e9}) cases.push_back(placedFarAway(foam, small, distance));
  for (const double distance : {1e3, 1e6, 1e9}) cases.push_back(savedFarAway(foam, small, distance));
  for (const double unit : {1e-6, 1e6}) cases.push_back(inUnits(foam, small, unit));
  if (!small.empty()) appendEyeCases(foam, small, cases);
  return cases;
}

}  // namespace froth
