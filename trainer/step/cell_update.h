// From what rays added up for a cell to its parameters' gradients, and Adam in the same breath: the gradients of lobes,
// nine tenths of all, are never stored.
//
// Order: of each cell that some pixel shows, updateDetail() for its detail sites, which adds to the cell's sums, and
// updateShownCell(); then of all cells updateBall(), which reads the sums of neighbours.
#pragma once

#include <cmath>

#include "shaders/foam/activations.h"
#include "shaders/foam/appearance_gradient.h"
#include "shaders/foam/cell_gradient.h"
#include "trainer/step/gradient_sums.h"
#include "trainer/step/seen_cells.h"

namespace froth {

// Stores the parameters of a cell as they are before adam.step.
template <class Real>
FROTH_HD void catchUpCell(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, uint32_t cell) {
  const TrainedCell<Real> trained(foam, adam, cell);
  if (trained.wait.isNone) return;
  for (size_t index = 0; index < kParameterCount; ++index) {
    const auto parameter = static_cast<Parameter>(index);
    if (!isWaiting(parameter)) continue;
    const ParameterPart<Real> part = trained.part(parameter);
    for (uint32_t i = 0; i < widthOf(parameter, foam.shape); ++i) part.store(i, part.load(i));
  }
  foam.lastSteps[cell] = adam.step - 1;
}

// What the lobes of a detail site have in common.
template <class Real>
struct LobeSeeds {
  glm::vec<3, Real> direction;  // in which the site is seen
  glm::vec<3, Real> blend;      // of the lobes' colours
  glm::vec<3, Real> seed;       // the gradient by it
};

template <class Real>
FROTH_HD LobeSeeds<Real> seedLobes(const SeenCell<Real>& seen, const SeenDetail<Real>& detail,
                                   const DetailSums<Real>& sums) {
  LobeSeeds<Real> seeds{directionOfDetail(seen, detail.place), detail.colour - Real(0.5), sums.colour};
  for (int c = 0; c < 3; ++c) seeds.seed[c] = foam::shownGradient(detail.colour[c], sums.colour[c]);
  return seeds;
}

template <class Real>
struct LobeGradient {
  glm::vec<3, Real> axis{0}, colour{0}, direction{0};
};

// share: of the lobe in the blend.
template <class Real>
FROTH_HD LobeGradient<Real> differentiateLobe(const glm::vec<3, Real>& axis, const glm::vec<3, Real>& colour,
                                              Real share, const LobeSeeds<Real>& seeds) {
  LobeGradient<Real> gradient;
  foam::lobeGradient(axis, seeds.direction, share * glm::dot(seeds.seed, colour - seeds.blend), gradient.axis,
                     gradient.direction);
  gradient.colour = share * seeds.seed;
  return gradient;
}

// Calls visit(first number, gradient) for the lobes of a detail site, whose numbers are `axes` and `colours`.
template <class Real, class Visit>
FROTH_HD void visitLobes(const ParameterPart<Real>& axes, const ParameterPart<Real>& colours, uint32_t lobeCount,
                         const LobeSeeds<Real>& seeds, const Visit& visit) {
  const uint32_t numbers = 3 * lobeCount;
  Real largest = Real(-1e30), weightSum = 0;
  for (uint32_t m = 0; m < numbers; m += 3) {
    glm::vec<3, Real> unused(0);
    foam::addLobe(foam::lobeExponent(axes.readThree(m), seeds.direction), glm::vec<3, Real>(0), largest, weightSum,
                  unused);
  }
  for (uint32_t m = 0; m < numbers; m += 3) {
    const glm::vec<3, Real> axis = axes.readThree(m);
    const Real share = std::exp(foam::lobeExponent(axis, seeds.direction) - largest) / weightSum;
    visit(m, differentiateLobe(axis, colours.readThree(m), share, seeds));
  }
}

template <class Real>
FROTH_HD void updateLobe(const ParameterPart<Real>& axes, const ParameterPart<Real>& colours, uint32_t m,
                         const LobeGradient<Real>& gradient, uint32_t& bad) {
  for (uint32_t c = 0; c < 3; ++c) {
    bad += !axes.update(m + c, gradient.axis[c]);
    bad += !colours.update(m + c, gradient.colour[c]);
  }
}

// The gradient of detail site k by its raw place and height, and the seed of its lobes; adds what its direction asks of
// the cell to `cellSums`. directionSeed: the sum of LobeGradient::direction.
template <class Real>
FROTH_HD DetailSums<Real> differentiatePlace(const TrainedCell<Real>& trained, const SeenCell<Real>& seen,
                                             const SeenDetail<Real>& detail, uint32_t k, const DetailSums<Real>& sums,
                                             const LobeSeeds<Real>& seeds, const glm::vec<3, Real>& directionSeed,
                                             CellSums<Real>& cellSums) {
  const glm::vec<3, Real> toDetail = vectorToDetail(seen, detail.place), place(detail.place, 0);
  const glm::vec<3, Real> moved = foam::detailDirectionGradient(toDetail, seeds.direction, directionSeed);
  const glm::vec<3, Real> inFrame =
      foam::inFaceFrame(moved, seen.tangent, glm::cross(seen.normal, seen.tangent), seen.normal, Real(1));
  cellSums.site += moved;
  cellSums.radius += glm::dot(place, inFrame) + trained.part(Parameter::kDetailHeights).read(k) * sums.height;
  cellSums.torque += glm::cross(inFrame, seen.radius * place);
  return {{sums.place.x + seen.radius * inFrame.x, sums.place.y + seen.radius * inFrame.y},
          seen.radius * sums.height,
          seeds.seed};
}

template <class Real>
FROTH_HD void updatePlace(const TrainedCell<Real>& trained, uint32_t k, const DetailSums<Real>& gradient,
                          uint32_t& bad) {
  const ParameterPart<Real> heights = trained.part(Parameter::kDetailHeights);
  const ParameterPart<Real> places = trained.part(Parameter::kDetailSites, 2 * k);
  bad += !heights.update(k, gradient.height);
  bad += !places.update(0, gradient.place.x);
  bad += !places.update(1, gradient.place.y);
}

// The numbers of the lobes of detail site k.
template <class Real>
FROTH_HD ParameterPart<Real> lobesOfDetail(const TrainedCell<Real>& trained, Parameter parameter, uint32_t k) {
  return trained.part(parameter, 3 * k * trained.foam.shape.lobeCount);
}

// All parameters of detail site k.
template <class Real>
FROTH_HD void updateDetail(const TrainedCell<Real>& trained, const SeenCell<Real>& seen, const SeenDetail<Real>& detail,
                           uint32_t k, const DetailSums<Real>& sums, CellSums<Real>& cellSums, uint32_t& bad) {
  const LobeSeeds<Real> seeds = seedLobes(seen, detail, sums);
  const ParameterPart<Real> axes = lobesOfDetail(trained, Parameter::kLobeAxes, k);
  const ParameterPart<Real> colours = lobesOfDetail(trained, Parameter::kLobeColours, k);
  glm::vec<3, Real> directionSeed(0);
  visitLobes(axes, colours, trained.foam.shape.lobeCount, seeds, [&](uint32_t m, const LobeGradient<Real>& gradient) {
    directionSeed += gradient.direction;
    updateLobe(axes, colours, m, gradient, bad);
  });
  updatePlace(trained, k, differentiatePlace(trained, seen, detail, k, sums, seeds, directionSeed, cellSums), bad);
}

// Density and orientation. From here on the cell waits.
template <class Real>
FROTH_HD void updateShownCell(const TrainedCell<Real>& trained, const CellSums<Real>& sums, uint32_t& bad) {
  const ParameterPart<Real> density = trained.part(Parameter::kDensity);
  const ParameterPart<Real> raw = trained.part(Parameter::kOrientations);
  bad += !density.update(0, sums.density * foam::softplusSlope(density.read(0)));
  const glm::vec<4, Real> quaternion(raw.readThree(0), raw.read(3));
  const glm::vec<4, Real> gradient = foam::quaternionGradient(quaternion, sums.torque);
  for (uint32_t c = 0; c < 4; ++c) bad += !raw.update(c, gradient[c]);
  trained.foam.lastSteps[trained.cell] = trained.adam.step;
}

// What the view's rays added up for a cell; null: it does not see the cell.
template <class Real>
FROTH_HD const CellSums<Real>* sumsOfCell(const SeenCells<Real>& seen, const GradientSums<Real>& sums, uint32_t cell) {
  const uint32_t rank = seen.rankOf[cell];
  return rank == SeenCells<Real>::kNotSeen ? nullptr : &sums.cells[rank];
}

// The gradient by site (xyz) and activated radius (w) of a cell is that of its own sums, and of all its pairs.
template <class Real>
FROTH_HD glm::vec<4, Real> gradientOfOwnSums(const CellSums<Real>* sums) {
  return sums == nullptr ? glm::vec<4, Real>(0) : glm::vec<4, Real>(sums->site, sums->radius);
}

// Of the loss of overlaps, at a ball: it sums squares of lengths.
template <class Real>
FROTH_HD Real overlapWeightAt(const Eyes& eyes, const glm::vec<4, Real>& ball, Real weight) {
  const Real unit = unitAt(eyes, ball);
  return weight / (unit * unit);
}

// Of the pair at place e of the cell's row: what its neighbour's rays and its own met, and the loss of overlaps.
// overlapWeight: overlapWeightAt() the cell.
template <class Real>
FROTH_HD glm::vec<4, Real> gradientOfPair(const TrainedFoam<Real>& foam, const NeighbourRows& rows,
                                          const SeenCells<Real>& seen, const GradientSums<Real>& sums,
                                          Real overlapWeight, uint32_t cell, uint32_t e) {
  using Vec3 = glm::vec<3, Real>;
  using Vec4 = glm::vec<4, Real>;
  const uint32_t neighbour = rows.neighbours[e];
  const Vec4 own = foam.balls[cell], other = foam.balls[neighbour];
  const Vec3 toNeighbour = Vec3(other) - Vec3(own);
  const uint32_t rank = seen.rankOf[cell], otherRank = seen.rankOf[neighbour];
  Vec4 gradient = overlapWeight * foam::overlapGradient(toNeighbour, own.w, other.w);
  if (rank != SeenCells<Real>::kNotSeen) {
    const uint32_t place = e - rows.offsets[cell];
    gradient += foam::gradientOfCell(sums.pairs[seen.cells[rank].planesBegin + place], own.w);
  }
  if (otherRank != SeenCells<Real>::kNotSeen) {
    const uint32_t place = rows.reverses[e] - rows.offsets[neighbour];
    const Vec4 pair = sums.pairs[seen.cells[otherRank].planesBegin + place];
    gradient += foam::gradientOfNeighbour(pair, -toNeighbour, own.w);
  }
  return gradient;
}

template <class Real>
FROTH_HD void updateBall(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, uint32_t cell,
                         const glm::vec<4, Real>& gradient, uint32_t& bad) {
  const ParameterPart<Real> point = partOf(foam, adam, Wait<Real>{}, Parameter::kPoints, cell);
  const ParameterPart<Real> radius = partOf(foam, adam, Wait<Real>{}, Parameter::kRadii, cell);
  for (uint32_t c = 0; c < 3; ++c) bad += !point.update(c, gradient[c]);
  bad += !radius.update(0, gradient.w * foam::softplusSlope(radius.read(0)));
}

// The means that densification goes by: of contributions over the photos that see the cell, of errors over all photos.
// sums: of a photo; null: it does not see the cell.
template <class Real>
FROTH_HD void updateMeans(const TrainedFoam<Real>& foam, uint32_t cell, const CellSums<Real>* sums) {
  const Real fresh = Real(0.01);
  foam.errors[cell] += fresh * ((sums != nullptr ? sums->error : Real(0)) - foam.errors[cell]);
  if (sums != nullptr) foam.contributions[cell] += fresh * (sums->contribution - foam.contributions[cell]);
}

}  // namespace froth
