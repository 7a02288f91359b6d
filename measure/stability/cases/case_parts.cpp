#include "measure/stability/cases/case_parts.h"

#include <cmath>

#include "base/counter_random.h"
#include "reference/camera/view_pose.h"

namespace froth {
namespace {

constexpr uint64_t kLookSeed = 7;

void addFace(const CaseCell& cell, uint32_t details, uint32_t lobes, Foam& foam) {
  const CounterRandom places(kLookSeed, Purpose::kDetail, cell.look), heights(kLookSeed, Purpose::kHeight, cell.look),
      axes(kLookSeed, Purpose::kAxis, cell.look), colours(kLookSeed, Purpose::kColour, cell.look);
  for (uint32_t k = 0; k < details; ++k) {
    foam.detailSites.emplace_back(places.uniform(2 * k, -0.7, 0.7), places.uniform(2 * k + 1, -0.7, 0.7));
    foam.detailHeights.push_back(cell.height + static_cast<float>(heights.uniform(k, -0.2, 0.2)));
    const glm::dvec3 base(colours.uniform(100 + 3 * k, -0.4, 0.4), colours.uniform(101 + 3 * k, -0.4, 0.4),
                          colours.uniform(102 + 3 * k, -0.4, 0.4));
    for (uint32_t m = 0; m < lobes; ++m) {
      const uint32_t lobe = k * lobes + m;
      const glm::dvec3 shift = 0.15 * colours.direction(1000 + lobe);
      foam.lobeAxes.emplace_back(axes.uniform(500 + lobe, 0.5, 6.0) * axes.direction(lobe));
      foam.lobeColours.emplace_back(base + shift);
    }
  }
}

View viewAlong(const glm::dvec3& eye, const glm::dvec3& forward, const glm::dvec3& up, uint32_t width,
               uint32_t height) {
  View view;
  setPose(view, eye, forward, up);
  view.width = width;
  view.height = height;
  view.cx = width / 2.0;
  view.cy = height / 2.0;
  view.nearDepth = view.nearRatio = 0;
  return view;
}

}  // namespace

Foam foamOfCells(const std::vector<CaseCell>& cells, uint32_t details, uint32_t lobes) {
  Foam foam;
  foam.cellCount = static_cast<uint32_t>(cells.size());
  foam.detailCount = details;
  foam.lobeCount = lobes;
  for (const CaseCell& cell : cells) {
    foam.sites.push_back(cell.site);
    foam.radii.push_back(cell.radius);
    foam.densities.push_back(cell.density);
    foam.orientations.push_back(cell.orientation);
    addFace(cell, details, lobes, foam);
  }
  return foam;
}

std::vector<CaseCell> cloud(uint32_t count, uint64_t seed, float step) {
  const CounterRandom sites(seed, Purpose::kSite), radii(seed, Purpose::kRadius), densities(seed, Purpose::kDensity),
      frames(seed, Purpose::kFrame);
  std::vector<CaseCell> cells;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 place(sites.uniform(3 * i, -1, 1), sites.uniform(3 * i + 1, -1, 1),
                          sites.uniform(3 * i + 2, -1, 1));
    const glm::dvec3 axis = frames.direction(i);
    const double half = frames.uniform(3 * count + i, 0, glm::pi<double>());
    CaseCell cell;
    cell.site = glm::round(place / step) * step;
    cell.radius = static_cast<float>(radii.uniform(i, 0.25, 0.6));
    cell.density = i % 8 == 7 ? 0.0f : static_cast<float>(densities.uniform(i, 1, 15));
    cell.orientation = glm::vec4(std::cos(half), glm::vec3(std::sin(half) * axis));
    cell.height = 0.1f;
    cell.look = i;
    cells.push_back(cell);
  }
  return cells;
}

Foam foamOfCubes(const glm::ivec3& count, const glm::vec3& first, float radius) {
  std::vector<CaseCell> cells;
  for (int z = 0; z < count.z; ++z) {
    for (int y = 0; y < count.y; ++y) {
      for (int x = 0; x < count.x; ++x) {
        const auto i = static_cast<uint32_t>(cells.size());
        cells.push_back({first + 0.5f * glm::vec3(x, y, z), radius, i % 3 == 0 ? 1.0f : 4.0f, kFaceToViewer, 5, i});
      }
    }
  }
  return foamOfCells(cells);
}

Foam foamOfBoxes() { return foamOfCubes({4, 4, 4}, {-0.75f, -0.75f, 0}, 0.375f); }

Foam scaledFoam(Foam foam, float factor) {
  for (glm::vec3& site : foam.sites) site *= factor;
  for (float& radius : foam.radii) radius *= factor;
  for (float& density : foam.densities) density /= factor;
  return foam;
}

Foam movedFoam(Foam foam, const glm::vec3& by) {
  for (glm::vec3& site : foam.sites) site += by;
  return foam;
}

View caseView(const glm::dvec3& eye, const glm::dvec3& target, uint32_t width, uint32_t height, double tanHalfFov,
              const glm::dvec3& up) {
  View view = viewAlong(eye, glm::normalize(target - eye), up, width, height);
  view.fx = view.fy = height / (2 * tanHalfFov);
  return view;
}

View orthographicView(const glm::dvec3& eye, const glm::dvec3& target, double halfHeight, uint32_t width,
                      uint32_t height) {
  View view = viewAlong(eye, glm::normalize(target - eye), {0, -1, 0}, width, height);
  view.lens.kind = LensKind::kOrthographic;
  view.fx = view.fy = height / (2 * halfHeight);
  return view;
}

std::vector<View> outsideViews(double distance) {
  const glm::dvec3 corner = distance * glm::normalize(glm::dvec3(0.8, -0.5, 0.6));
  return {caseView({0, 0, -distance}, {0, 0, 0}), caseView(corner, {0, 0, 0})};
}

}  // namespace froth
