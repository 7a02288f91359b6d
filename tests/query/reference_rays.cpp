#include "tests/query/reference_rays.h"

#include <algorithm>
#include <cmath>

#include "foam/cech_pairs.h"
#include "reference/render/ray.h"

namespace froth::test {
namespace {

struct MetBall {
  double power;
  uint32_t cell;
  BallHit<double> hit;
};

}  // namespace

ReferenceRays::ReferenceRays(const Foam& foam)
    : foam_(foam),
      tree_(foam.sites, foam.radii, findVisibleCells(foam)),
      pairs_(findCechPairs(foam.sites, foam.radii)) {}

ReferenceHit ReferenceRays::cast(const glm::dvec3& origin, const glm::dvec3& direction, double tEnd, double quantile,
                                 double cutoff) const {
  std::vector<MetBall> balls;
  tree_.searchRay(origin, direction, [&](uint32_t cell) {
    MetBall ball{0, cell, {}};
    const glm::dvec3 centre = glm::dvec3(foam_.sites[cell]) - origin;
    if (!foam::intersectBall(centre, double{foam_.radii[cell]}, direction, ball.hit.tNear, ball.hit.tFar)) return;
    ball.power = foam::powerOfOrigin(centre, double{foam_.radii[cell]});
    ball.hit.tFar = std::min(ball.hit.tFar, tEnd);
    if (ball.hit.tNear < ball.hit.tFar) balls.push_back(ball);
  });
  std::sort(balls.begin(), balls.end(),
            [](const MetBall& a, const MetBall& b) { return std::pair(a.power, a.cell) < std::pair(b.power, b.cell); });

  // A view in which only these cells are.
  ViewCells<double> view;
  view.detailCount = foam_.detailCount;
  std::vector<BallHit<double>> hits;
  for (MetBall& ball : balls) {
    ball.hit.rank = static_cast<uint32_t>(hits.size());
    hits.push_back(ball.hit);
    const glm::dvec3 site(foam_.sites[ball.cell]);
    const double radius = foam_.radii[ball.cell];
    ViewCell<double> cell{};
    cell.centre = site - origin;
    cell.radius = radius;
    cell.inverseRadius = 1 / radius;
    cell.density = foam_.densities[ball.cell];
    cell.frame = faceFrame<double>(foam_.orientations[ball.cell]);
    cell.planesBegin = view.planes.size();
    for (const uint32_t other : neighboursOf(pairs_, ball.cell)) {
      const glm::dvec3 toNeighbour = glm::dvec3(foam_.sites[other]) - site;
      const glm::dvec3 otherCentre = glm::dvec3(foam_.sites[other]) - origin;
      view.planes.push_back({toNeighbour, foam::sharedClearance(cell.centre, otherCentre, toNeighbour, radius,
                                                                double{foam_.radii[other]})});
    }
    cell.planesEnd = view.planes.size();
    view.cells.push_back(cell);
    for (uint32_t k = 0; k < foam_.detailCount; ++k) {
      const size_t detail = size_t{ball.cell} * foam_.detailCount + k;
      view.details.push_back({foam_.detailSites[detail], radius * foam_.detailHeights[detail], {}});
    }
  }
  constexpr double kDetailSharpness = 10;
  const PrimaryRay<double> primary{glm::dvec3(0), direction};
  const RayResult<double> ray =
      compositeHits(view, primary, RaySettings<double>{cutoff, std::log(quantile), kDetailSharpness}, hits);
  return {std::exp(ray.logTransmittance), ray.distance};
}

}  // namespace froth::test
