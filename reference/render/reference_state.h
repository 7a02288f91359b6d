// What the renders of one foam and of several have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "foam/cech_pairs.h"
#include "foam/site_tree.h"
#include "reference/camera/view_rays.h"
#include "reference/render/ray.h"
#include "reference/render/reference.h"
#include "reference/render/rounding.h"
#include "reference/render/view_cells.h"

namespace froth {

struct ReferenceRenderer::State {
  State(const Foam& source, const Progress& progress)
      : foam(source),
        visible(findVisibleCells(source)),
        cechPairs(findCechPairs(source.sites, source.radii, progress)),
        tree(source.sites, source.radii, visible) {}

  const Foam& foam;
  const std::vector<uint32_t> visible;
  const CellGraph cechPairs;  // without offsets: stopped on request
  const SiteTree tree;
};

// Of a view and options that a caller gave.
Status checkRender(const View& view, const ReferenceOptions& options);

// Without anything in them.
RenderedImages emptyImages(const View& view);

// Calls renderRow(y) from all threads, and reports about a hundred times. Fails with kCancelled.
Status renderRows(uint32_t rows, const Progress& progress, const std::function<void(uint32_t y)>& renderRow);

// Where the scene ends a ray; infinity: nowhere. A place errs by its distance from the eye, which of parallel rays is
// no part of 0. From a depth along the view axis the distance is depth / c, c = axis . direction. Sums of rounded
// products, c errs by some units of 1, not of itself: so the distance errs by parts of its 1 / c.
inline double endOfRay(const ReferenceOptions& options, const ViewRay& ray, uint32_t x, uint32_t y) {
  if (!options.sceneDistance) return std::numeric_limits<double>::infinity();
  const double end = *options.sceneDistance->pixel(x, y);
  if (options.rounding == 0 || std::isinf(end)) return end;
  Rounding rounding(options.rounding, options.roundingSeed + 3, y * options.sceneDistance->width + x);
  const double ahead = std::max(end, 0.0);  // depth knows nothing behind the start of a ray: that errs as what is at it
  const double cosine = options.depthAxis == glm::dvec3(0) ? 1 : glm::dot(options.depthAxis, ray.direction);
  return std::max(rounding.of(ahead, glm::length(ray.offset + ahead * ray.direction) / cosine), 0.0);
}

// The balls that a ray from `origin` meets before `end`. primary: in the precision of the render, as the cells are.
template <class Real>
void gatherHits(const SiteTree& tree, const ViewCells<Real>& cells, const glm::dvec3& origin,
                const PrimaryRay<Real>& primary, Real end, std::vector<BallHit<Real>>& hits) {
  hits.clear();
  tree.searchRay(origin, glm::dvec3(primary.direction), [&](uint32_t source) {
    BallHit<Real> hit{cells.rankOf[source], 0, 0};
    if (hit.rank == ViewCells<Real>::kNotDrawn) return;
    const ViewCell<Real>& cell = cells.cells[hit.rank];
    if (!foam::intersectBall(cell.centre - primary.offset, cell.radius, primary.direction, hit.tNear, hit.tFar)) return;
    hit.tFar = std::min(hit.tFar, end);
    if (hit.tNear < hit.tFar) hits.push_back(hit);
  });
}

template <class Real>
void writePixel(const RayResult<Real>& ray, uint32_t x, uint32_t y, RenderedImages& images) {
  for (int c = 0; c < 3; ++c) {
    images.colour.pixel(x, y)[c] = static_cast<float>(ray.colour[c]);
    images.normal.pixel(x, y)[c] = static_cast<float>(ray.normal[c]);
  }
  *images.alpha.pixel(x, y) = static_cast<float>(foam::coverageOf(ray.logTransmittance));
  *images.distance.pixel(x, y) = static_cast<float>(ray.distance);
  const size_t pixel = size_t{y} * images.alpha.width + x;
  for (size_t i = 0; i < 4; ++i) images.quarters[pixel][i] = static_cast<float>(ray.quarters[i]);
}

}  // namespace froth
