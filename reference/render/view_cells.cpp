#include "reference/render/view_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "reference/render/rounding.h"
#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

template <class Real>
using Vec3 = glm::vec<3, Real>;

// Near tests (docs/FOAM.md "Near cells"): once per cell, in double.
std::vector<uint32_t> selectDrawnCells(const Foam& foam, std::span<const uint32_t> candidates, const View& view,
                                       const ReferenceOptions& options) {
  const bool isOrthographic = view.lens.kind == LensKind::kOrthographic;
  const double nearRatio = isOrthographic ? 0 : options.nearRatio;
  const double nearDepth = looksForward(view.lens.kind) ? options.nearDepth : 0;
  const glm::dvec3 eye = eyeOf(view), forward = forwardOf(view);
  std::vector<uint32_t> drawn;
  for (uint32_t cell : candidates) {
    Rounding rounding(options.rounding, options.roundingSeed + 3, cell);
    const glm::dvec3 centre = rounding.of(glm::dvec3(foam.sites[cell]) - eye);
    const double radius = rounding.of(double{foam.radii[cell]});
    if (!foam::isNearCell(centre, radius, forward, nearRatio, nearDepth)) drawn.push_back(cell);
  }
  return drawn;
}

// By the power of the eye, or along the parallel rays; equals by index (docs/FOAM.md "Order").
template <class Real>
void sortFrontToBack(const Foam& foam, const View& view, const ReferenceOptions& options,
                     std::vector<uint32_t>& cells) {
  const bool isOrthographic = view.lens.kind == LensKind::kOrthographic;
  const glm::dvec3 eye = eyeOf(view);
  const Vec3<Real> forward(forwardOf(view));
  std::vector<Real> keys(foam.cellCount);
  for (uint32_t cell : cells) {
    const Vec3<Real> centre(glm::dvec3(foam.sites[cell]) - eye);
    const Real radius = foam.radii[cell];
    Rounding rounding(options.rounding, options.roundingSeed + 1, cell);
    keys[cell] = isOrthographic
                     ? rounding.of(glm::dot(forward, centre), glm::length(centre))
                     : rounding.of(foam::powerOfOrigin(centre, radius), glm::dot(centre, centre) + radius * radius);
  }
  std::sort(cells.begin(), cells.end(),
            [&](uint32_t a, uint32_t b) { return std::pair(keys[a], a) < std::pair(keys[b], b); });
}

// The colour of a detail site from the eye: its lobes weighed by the direction in which it is seen.
template <class Real>
Vec3<Real> seeDetail(const Foam& foam, size_t detail, const Vec3<Real>& direction, Rounding& rounding) {
  const LobeRange lobes = lobesOf(foam, detail);
  Real largest = -std::numeric_limits<Real>::max(), weightSum = 0;
  Vec3<Real> colourSum(0);
  for (uint64_t m = lobes.first; m < lobes.first + lobes.count; ++m) {
    const Real exponent = rounding.of(foam::lobeExponent(Vec3<Real>(foam.lobeAxes[m]), direction));
    foam::addLobe(exponent, rounding.of(Vec3<Real>(foam.lobeColours[m])), largest, weightSum, colourSum);
  }
  const Vec3<Real> base = foam.baseColours.empty() ? Vec3<Real>(0) : Vec3<Real>(foam.baseColours[detail]);
  return foam::lobeColour(base, weightSum, colourSum);
}

template <class Real>
void fillDetails(const Foam& foam, uint32_t source, const ViewCell<Real>& cell, const View& view, Rounding& rounding,
                 std::span<ViewDetail<Real>> details) {
  const bool isOrthographic = view.lens.kind == LensKind::kOrthographic;
  const Vec3<Real> forward(forwardOf(view));
  for (size_t k = 0; k < details.size(); ++k) {
    const size_t own = size_t{source} * details.size() + k;
    ViewDetail<Real>& detail = details[k];
    const glm::vec2 place = foam.detailSites[own];
    detail.place = {rounding.of(Real(place.x)), rounding.of(Real(place.y))};
    detail.height = rounding.of(cell.radius * Real(foam.detailHeights[own]));
    const Vec3<Real> fromEye =
        cell.centre + cell.radius * (detail.place.x * cell.frame.tangent + detail.place.y * cell.frame.bitangent);
    const Vec3<Real> direction = isOrthographic ? forward : foam::directionToDetail(fromEye, cell.frame.normal);
    const Vec3<Real> colour = seeDetail(foam, own, rounding.of(direction), rounding);
    detail.colour = {rounding.of(colour.x), rounding.of(colour.y), rounding.of(colour.z)};
  }
}

// As seen from its first site (shaders/foam/cell.h). Both cells find the same plane, with the same error.
template <class Real>
ViewPlane<Real> planeBetween(const Foam& foam, uint32_t first, uint32_t second, const glm::dvec3& eye,
                             const ReferenceOptions& options) {
  const Vec3<Real> toSecond(glm::dvec3(foam.sites[second]) - glm::dvec3(foam.sites[first]));
  const Vec3<Real> centre(glm::dvec3(foam.sites[first]) - eye);
  const Real offset = foam::radicalOffset(toSecond, Real(foam.radii[first]), Real(foam.radii[second]));
  const Real size = glm::length(toSecond);
  Rounding rounding(options.rounding, options.roundingSeed + 2, first, second);
  const Vec3<Real> rounded = rounding.of(toSecond);
  return {rounded, rounding.of(foam::radicalClearance(centre, toSecond, offset),
                               size * (size + glm::length(centre)) + std::abs(offset))};
}

template <class Real>
void fillPlanes(const Foam& foam, std::span<const uint32_t> neighbours, uint32_t source, const glm::dvec3& eye,
                const ReferenceOptions& options, std::span<ViewPlane<Real>> planes) {
  for (size_t i = 0; i < planes.size(); ++i) {
    const uint32_t other = neighbours[i];
    if (foam::comesFirst(glm::dvec3(foam.sites[other]) - glm::dvec3(foam.sites[source]))) {
      planes[i] = planeBetween<Real>(foam, source, other, eye, options);
    } else {
      const ViewPlane<Real> plane = planeBetween<Real>(foam, other, source, eye, options);
      planes[i] = {-plane.toNeighbour, -plane.clearance};
    }
  }
}

}  // namespace

std::vector<uint32_t> findVisibleCells(const Foam& foam) {
  std::vector<uint32_t> cells(foam.cellCount);
  for (uint32_t i = 0; i < foam.cellCount; ++i) cells[i] = i;
  const auto key = [&](uint32_t i) {
    const glm::vec3& p = foam.sites[i];
    return std::tuple(p.x, p.y, p.z, -foam.radii[i], i);
  };
  std::sort(cells.begin(), cells.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  const auto isSameSite = [&](uint32_t a, uint32_t b) { return foam.sites[a] == foam.sites[b]; };
  cells.erase(std::unique(cells.begin(), cells.end(), isSameSite), cells.end());
  std::erase_if(cells, [&](uint32_t i) { return !(foam.densities[i] > 0); });
  return cells;
}

template <class Real>
ViewCells<Real> prepareViewCells(const Foam& foam, const CellGraph& cechPairs, std::span<const uint32_t> candidates,
                                 const View& view, const ReferenceOptions& options) {
  const glm::dvec3 eye = eyeOf(view);
  std::vector<uint32_t> drawn = selectDrawnCells(foam, candidates, view, options);
  sortFrontToBack<Real>(foam, view, options, drawn);

  ViewCells<Real> result;
  result.detailCount = foam.detailCount;
  result.rankOf.assign(foam.cellCount, ViewCells<Real>::kNotDrawn);
  result.cells.resize(drawn.size());
  uint64_t planeCount = 0;
  for (uint32_t rank = 0; rank < drawn.size(); ++rank) {
    result.rankOf[drawn[rank]] = rank;
    result.cells[rank].planesBegin = planeCount;
    planeCount += cechPairs.offsets[drawn[rank] + 1] - cechPairs.offsets[drawn[rank]];
    result.cells[rank].planesEnd = planeCount;
  }
  result.planes.resize(planeCount);
  result.details.resize(drawn.size() * foam.detailCount);

  tbb::parallel_for(size_t{0}, drawn.size(), [&](size_t rank) {
    const uint32_t source = drawn[rank];
    ViewCell<Real>& cell = result.cells[rank];
    Rounding rounding(options.rounding, options.roundingSeed, source);
    cell.centre = rounding.of(Vec3<Real>(glm::dvec3(foam.sites[source]) - eye));
    cell.radius = rounding.of(Real(foam.radii[source]));
    cell.inverseRadius = 1 / cell.radius;
    cell.density = rounding.of(Real(foam.densities[source]));
    const FaceFrame<Real> frame = faceFrame<Real>(foam.orientations[source]);
    cell.frame = {rounding.of(frame.normal), rounding.of(frame.tangent), rounding.of(frame.bitangent)};
    cell.nearError = rounding.of(Real(0), Real(1));
    cell.farError = rounding.of(Real(0), Real(1));
    fillDetails(foam, source, cell, view, rounding,
                std::span(result.details).subspan(rank * foam.detailCount, foam.detailCount));
    const size_t planes = cell.planesEnd - cell.planesBegin;
    fillPlanes(foam, std::span(cechPairs.neighbours).subspan(cechPairs.offsets[source], planes), source, eye, options,
               std::span(result.planes).subspan(cell.planesBegin, planes));
  });
  return result;
}

template ViewCells<float> prepareViewCells(const Foam&, const CellGraph&, std::span<const uint32_t>, const View&,
                                           const ReferenceOptions&);
template ViewCells<double> prepareViewCells(const Foam&, const CellGraph&, std::span<const uint32_t>, const View&,
                                            const ReferenceOptions&);

}  // namespace froth
