// Rays that a scene ends: in the middle of cells, where cells begin and end, at once and never.
#include <algorithm>
#include <functional>
#include <limits>

#include "measure/stability/cases/case_parts.h"
#include "reference/camera/view_rays.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

// endOf(ray, start of the ray, number of the pixel).
Image endsOf(const View& view, const std::function<double(const ViewRay&, const glm::dvec3&, uint32_t)>& endOf) {
  Image ends{view.width, view.height, 1, {}};
  const ViewRays rays(view);
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const std::optional<ViewRay> ray = rays.ofPixel(x, y);
      ends.values.push_back(ray ? static_cast<float>(endOf(*ray, eyeOf(view) + ray->offset, y * view.width + x))
                                : kNever);
    }
  }
  return ends;
}

// Where a ray enters the ball of this number of those that it meets; none so many: the last; none: it never ends.
double entryOf(const Foam& foam, const ViewRay& ray, const glm::dvec3& start, uint32_t number) {
  std::vector<double> entries;
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    double tNear = 0, tFar = 0;
    const glm::dvec3 centre = glm::dvec3(foam.sites[cell]) - start;
    if (foam::intersectBall(centre, double{foam.radii[cell]}, ray.direction, tNear, tFar) && tNear > 0) {
      entries.push_back(tNear);
    }
  }
  if (entries.empty()) return kNever;
  std::sort(entries.begin(), entries.end());
  return entries[std::min<size_t>(number, entries.size() - 1)];
}

View panorama(const glm::dvec3& eye) {
  View view = caseView(eye, {0, 0, 1}, 48, 24);
  view.lens.kind = LensKind::kEquirectangular;
  view.fx = view.fy = 24 / glm::pi<double>();
  return view;
}

std::vector<View> allLenses() {
  return {caseView({0, 0, -3.5}, {0, 0, 0}), orthographicView({0, 0, -3}, {0, 0, 0}, 1.2), panorama({0.1, 0.2, -0.3})};
}

StiffCase ended(const std::string& name, const std::string& what, const std::string& analysis, const Foam& foam,
                std::vector<View> views,
                const std::function<double(const ViewRay&, const glm::dvec3&, uint32_t)>& endOf) {
  StiffCase stiff{name, what, analysis, foam, std::move(views)};
  for (const View& view : stiff.views) stiff.ends.push_back(endsOf(view, endOf));
  return stiff;
}

}  // namespace

std::vector<StiffCase> depthCases() {
  const Foam foam = foamOfCells(cloud(40, 91));
  return {
      ended("depth/wall", "a wall through the middle of the foam ends all rays",
            "An interval that is cut is as long as the wall's distance says, which is rounded once.", foam, allLenses(),
            [](const ViewRay& ray, const glm::dvec3& start, uint32_t) {
              const glm::dvec3 normal = glm::normalize(glm::dvec3(0.55, 0.2, -1));
              const double t = -glm::dot(normal, start) / glm::dot(normal, ray.direction);
              return t > 0 ? t : kNever;
            }),
      ended("depth/on_entries", "rays end where they enter a ball, one of those that they meet",
            "Nothing is left of the interval behind, or as much as rounding.", foam, allLenses(),
            [foam](const ViewRay& ray, const glm::dvec3& start, uint32_t pixel) {
              return entryOf(foam, ray, start, pixel % 4);
            }),
      ended("depth/on_planes", "rays end in the planes between cells",
            "As on spheres; which of two cells has the plane changes nothing.", foamOfBoxes(),
            {orthographicView({0.03, 0.02, -3}, {0.03, 0.02, 0}, 1.2), caseView({0, 0, -3}, {0, 0, 0})},
            [](const ViewRay& ray, const glm::dvec3& start, uint32_t pixel) {
              return (0.25 + 0.5 * (pixel % 3) - start.z) / ray.direction.z;
            }),
      ended("depth/at_once_and_never", "rays end at 0, at the smallest and largest numbers, and never",
            "What ends at once shows nothing; what ends beyond all cells shows them all.", foam,
            {orthographicView({0, 0, 0}, {0.3, 0.2, 1}, 1.2), panorama({0.1, 0.2, -0.3})},
            [](const ViewRay&, const glm::dvec3&, uint32_t pixel) {
              constexpr double kEnds[] = {0, 1e-30, 1e-6, 1e5, kNever};
              return kEnds[pixel % 5];
            })};
}

}  // namespace froth
