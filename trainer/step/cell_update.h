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

// Updates the lobes of detail site k; returns the gradient by the direction in which it is seen.
template <class Real>
FROTH_HD glm::vec<3, Real> updateLobes(const TrainedCell<Real>& trained, uint32_t k, const LobeSeeds<Real>& seeds,
                                       uint32_t& bad) {
  const uint32_t numbers = 3 * trained.foam.shape.lobeCount;
  const ParameterPart<Real> axes = trained.part(Parameter::kLobeAxes, k * numbers);
  const ParameterPart<Real> colours = trained.part(Parameter::kLobeColours, k * numbers);
  Real largest = Real(-1e30), weightSum = 0;
  for (uint32_t m = 0; m < numbers; m += 3) {
    glm::vec<3, Real> unused(0);
    foam::addLobe(foam::lobeExponent(axes.readThree(m), seeds.direction), glm::vec<3, Real>(0), largest, weightSum,
                  unused);
  }
  glm::vec<3, Real> directionSum(0);
  for (uint32_t m = 0; m < numbers; m += 3) {
    const glm::vec<3, Real> axis = axes.readThree(m);
    const Real share = std::exp(foam::lobeExponent(axis, seeds.direction) - largest) / weightSum;
    const LobeGradient<Real> gradient = differentiateLobe(axis, colours.readThree(m), share, seeds);
    directionSum += gradient.direction;
    for (uint32_t c = 0; c < 3; ++c) {
      bad += !axes.update(m + c, gradient.axis[c]);
      bad += !colours.update(m + c, gradient.colour[c]);
    }
  }
  return directionSum;
}

// Place and height of detail site k; adds what its direction asks of the cell to `cellSums`. directionSeed: of
// updateLobes().
template <class Real>
FROTH_HD void updatePlace(const TrainedCell<Real>& trained, const SeenCell<Real>& seen, const SeenDetail<Real>& detail,
                          uint32_t k, const DetailSums<Real>& sums, const LobeSeeds<Real>& seeds,
                          const glm::vec<3, Real>& directionSeed, CellSums<Real>& cellSums, uint32_t& bad) {
  const glm::vec<3, Real> toDetail = vectorToDetail(seen, detail.place), place(detail.place, 0);
  const glm::vec<3, Real> moved = foam::detailDirectionGradient(toDetail, seeds.direction, directionSeed);
  const glm::vec<3, Real> inFrame =
      foam::inFaceFrame(moved, seen.tangent, glm::cross(seen.normal, seen.tangent), seen.normal, Real(1));
  const ParameterPart<Real> heights = trained.part(Parameter::kDetailHeights);
  const ParameterPart<Real> places = trained.part(Parameter::kDetailSites, 2 * k);
  cellSums.site += moved;
  cellSums.radius += glm::dot(place, inFrame) + heights.read(k) * sums.height;
  cellSums.torque += glm::cross(inFrame, seen.radius * place);
  bad += !heights.update(k, seen.radius * sums.height);
  bad += !places.update(0, sums.place.x + seen.radius * inFrame.x);
  bad += !places.update(1, sums.place.y + seen.radius * inFrame.y);
}

// All parameters of detail site k.
template <class Real>
FROTH_HD void updateDetail(const TrainedCell<Real>& trained, const SeenCell<Real>& seen, const SeenDetail<Real>& detail,
                           uint32_t k, const DetailSums<Real>& sums, CellSums<Real>& cellSums, uint32_t& bad) {
  const LobeSeeds<Real> seeds = seedLobes(seen, detail, sums);
  const glm::vec<3, Real> directionSeed = updateLobes(trained, k, seeds, bad);
  updatePlace(trained, seen, detail, k, sums, seeds, directionSeed, cellSums, bad);
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

// The gradient by site (xyz) and activated radius (w) of a cell is that of its own sums, and of all its pairs.
template <class Real>
FROTH_HD glm::vec<4, Real> gradientOfOwnSums(const SeenCells<Real>& seen, const GradientSums<Real>& sums,
                                             uint32_t cell) {
  const uint32_t rank = seen.rankOf[cell];
  if (rank == SeenCells<Real>::kNotSeen) return glm::vec<4, Real>(0);
  return {sums.cells[rank].site, sums.cells[rank].radius};
}

// Of the pair at place e of the cell's row: what its neighbour's rays and its own met, and the loss of overlaps.
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

// The means that densification goes by: of contributions over the steps that see the cell, of errors over all steps.
template <class Real>
FROTH_HD void updateMeans(const TrainedFoam<Real>& foam, const SeenCells<Real>& seen, const GradientSums<Real>& sums,
                          uint32_t cell) {
  const Real fresh = Real(0.01);
  const uint32_t rank = seen.rankOf[cell];
  const bool isSeen = rank != SeenCells<Real>::kNotSeen;
  foam.errors[cell] += fresh * ((isSeen ? sums.cells[rank].error : Real(0)) - foam.errors[cell]);
  if (isSeen) foam.contributions[cell] += fresh * (sums.cells[rank].contribution - foam.contributions[cell]);
}

}  // namespace froth
