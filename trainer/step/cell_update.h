// From what rays added up for a cell to its parameters' gradients, and Adam in the same breath: the gradients of lobes,
// nine tenths of all, are never stored.
//
// Order: catchUpCell() before a view looks at the cell; updateDetail() for each of its detail sites, which adds to the
// cell's sums; updateSeenCell(); and for all cells, seen or not, updateBall(), which reads the sums of neighbours.
#pragma once

#include <cmath>

#include "shaders/foam/activations.h"
#include "shaders/foam/appearance_gradient.h"
#include "shaders/foam/cell_gradient.h"
#include "trainer/step/adam.h"
#include "trainer/step/gradient_sums.h"
#include "trainer/step/seen_cells.h"

namespace froth {

// Whether a parameter waits while no view sees its cell.
FROTH_HD bool isWaiting(Parameter parameter) {
  return parameter != Parameter::kPoints && parameter != Parameter::kRadii;
}

// Three rows of one parameter of one cell, or a part of them.
template <class Real>
struct ParameterPart {
  Real *values, *firstMoments, *secondMoments;
};

template <class Real>
FROTH_HD ParameterPart<Real> partOf(const TrainedFoam<Real>& foam, Parameter parameter, uint32_t cell,
                                    uint32_t first = 0) {
  return {foam.values.row(parameter, foam.shape, cell) + first,
          foam.firstMoments.row(parameter, foam.shape, cell) + first,
          foam.secondMoments.row(parameter, foam.shape, cell) + first};
}

template <class Real>
FROTH_HD bool updatePart(const ParameterPart<Real>& part, uint32_t i, Real gradient, const AdamStep<Real>& adam,
                         Parameter parameter) {
  return updateValue(part.values[i], part.firstMoments[i], part.secondMoments[i], gradient,
                     adam.rates[static_cast<size_t>(parameter)], adam.epsilon);
}

// Brings the waiting parameters of a cell to the step before adam.step.
template <class Real>
FROTH_HD void catchUpCell(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, uint32_t cell) {
  const uint32_t lastStep = foam.lastSteps[cell];
  if (lastStep + 1 >= adam.step) return;
  for (size_t index = 0; index < kParameterCount; ++index) {
    const auto parameter = static_cast<Parameter>(index);
    if (!isWaiting(parameter)) continue;
    const Wait<Real> wait = waitSince(adam, parameter, lastStep);
    const ParameterPart<Real> part = partOf(foam, parameter, cell);
    const uint32_t width = widthOf(parameter, foam.shape);
    for (uint32_t i = 0; i < width; ++i) {
      catchUp(part.values[i], part.firstMoments[i], part.secondMoments[i], wait);
    }
  }
  foam.lastSteps[cell] = adam.step - 1;
}

// Updates the lobes of detail site k; returns the gradient by the direction in which it is seen.
template <class Real>
FROTH_HD glm::vec<3, Real> updateLobes(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, uint32_t cell,
                                       uint32_t k, const glm::vec<3, Real>& direction, const glm::vec<3, Real>& seed,
                                       const glm::vec<3, Real>& blendOffset, uint32_t& bad) {
  using Vec3 = glm::vec<3, Real>;
  const uint32_t lobeCount = foam.shape.lobeCount, first = 3 * k * lobeCount;
  const ParameterPart<Real> axes = partOf(foam, Parameter::kLobeAxes, cell, first);
  const ParameterPart<Real> colours = partOf(foam, Parameter::kLobeColours, cell, first);
  Real largest = Real(-1e30), weightSum = 0;
  for (uint32_t m = 0; m < 3 * lobeCount; m += 3) {
    const Real exponent = foam::lobeExponent(Vec3(axes.values[m], axes.values[m + 1], axes.values[m + 2]), direction);
    Vec3 unused(0);
    foam::addLobe(exponent, Vec3(0), largest, weightSum, unused);
  }
  Vec3 directionSum(0);
  for (uint32_t m = 0; m < 3 * lobeCount; m += 3) {
    const Vec3 axis(axes.values[m], axes.values[m + 1], axes.values[m + 2]);
    const Vec3 colour(colours.values[m], colours.values[m + 1], colours.values[m + 2]);
    const Real share = std::exp(foam::lobeExponent(axis, direction) - largest) / weightSum;
    Vec3 axisGradient, directionGradient;
    foam::lobeGradient(axis, direction, share * glm::dot(seed, colour - blendOffset), axisGradient, directionGradient);
    directionSum += directionGradient;
    for (uint32_t c = 0; c < 3; ++c) {
      bad += !updatePart(axes, m + c, axisGradient[c], adam, Parameter::kLobeAxes);
      bad += !updatePart(colours, m + c, share * seed[c], adam, Parameter::kLobeColours);
    }
  }
  return directionSum;
}

// All parameters of detail site k; adds what its direction asks of the cell to `sums`.
template <class Real>
FROTH_HD void updateDetail(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, const SeenCell<Real>& seen,
                           const SeenDetail<Real>& detail, uint32_t k, const DetailSums<Real>& detailSums,
                           CellSums<Real>& sums, uint32_t& bad) {
  using Vec3 = glm::vec<3, Real>;
  const Vec3 bitangent = glm::cross(seen.normal, seen.tangent);
  const Vec3 toDetail = seen.centre + seen.radius * (detail.place.x * seen.tangent + detail.place.y * bitangent);
  const Vec3 direction = foam::directionToDetail(toDetail, seen.normal);
  const Vec3 seed(foam::shownGradient(detail.colour.x, detailSums.colour.x),
                  foam::shownGradient(detail.colour.y, detailSums.colour.y),
                  foam::shownGradient(detail.colour.z, detailSums.colour.z));
  const Vec3 directionSeed = updateLobes(foam, adam, seen.cell, k, direction, seed, detail.colour - Real(0.5), bad);
  const Vec3 moved = foam::detailDirectionGradient(toDetail, direction, directionSeed);
  const Vec3 inFrame = foam::inFaceFrame(moved, seen.tangent, bitangent, seen.normal, Real(1));
  const Vec3 place(detail.place, 0);

  const ParameterPart<Real> heights = partOf(foam, Parameter::kDetailHeights, seen.cell);
  const ParameterPart<Real> places = partOf(foam, Parameter::kDetailSites, seen.cell, 2 * k);
  sums.site += moved;
  sums.radius += glm::dot(place, inFrame) + heights.values[k] * detailSums.height;
  sums.torque += glm::cross(inFrame, seen.radius * place);
  bad += !updatePart(heights, k, seen.radius * detailSums.height, adam, Parameter::kDetailHeights);
  bad += !updatePart(places, 0, detailSums.place.x + seen.radius * inFrame.x, adam, Parameter::kDetailSites);
  bad += !updatePart(places, 1, detailSums.place.y + seen.radius * inFrame.y, adam, Parameter::kDetailSites);
}

// Density and orientation.
template <class Real>
FROTH_HD void updateSeenCell(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, const SeenCell<Real>& seen,
                             const CellSums<Real>& sums, uint32_t& bad) {
  const ParameterPart<Real> density = partOf(foam, Parameter::kDensity, seen.cell);
  const ParameterPart<Real> raw = partOf(foam, Parameter::kOrientations, seen.cell);
  bad += !updatePart(density, 0, sums.density * foam::softplusSlope(density.values[0]), adam, Parameter::kDensity);
  const glm::vec<4, Real> quaternion(raw.values[0], raw.values[1], raw.values[2], raw.values[3]);
  const glm::vec<4, Real> gradient = foam::quaternionGradient(quaternion, sums.torque);
  for (int c = 0; c < 4; ++c) bad += !updatePart(raw, c, gradient[c], adam, Parameter::kOrientations);
  foam.lastSteps[seen.cell] = adam.step;
}

// The gradient by site (xyz) and activated radius (w) of a cell: its own sums, those of the pairs that its neighbours'
// rays and its own met, and the loss of overlaps.
template <class Real>
FROTH_HD glm::vec<4, Real> gatherBall(const TrainedFoam<Real>& foam, const NeighbourRows& rows,
                                      const SeenCells<Real>& seen, const GradientSums<Real>& sums, Real overlapWeight,
                                      uint32_t cell) {
  using Vec3 = glm::vec<3, Real>;
  using Vec4 = glm::vec<4, Real>;
  const Vec4 own = foam.balls[cell];
  const uint32_t rank = seen.rankOf[cell], begin = rows.offsets[cell];
  const bool isSeen = rank != SeenCells<Real>::kNotSeen;
  Vec4 gradient = isSeen ? Vec4(sums.cells[rank].site, sums.cells[rank].radius) : Vec4(0);
  for (uint32_t e = begin; e < rows.offsets[cell + 1]; ++e) {
    const uint32_t neighbour = rows.neighbours[e];
    const Vec4 other = foam.balls[neighbour];
    const Vec3 toNeighbour = Vec3(other) - Vec3(own);
    if (isSeen) gradient += foam::gradientOfCell(sums.pairs[seen.cells[rank].planesBegin + e - begin], own.w);
    const uint32_t otherRank = seen.rankOf[neighbour];
    if (otherRank != SeenCells<Real>::kNotSeen) {
      const uint32_t place = rows.reverses[e] - rows.offsets[neighbour];
      const Vec4 pair = sums.pairs[seen.cells[otherRank].planesBegin + place];
      gradient += foam::gradientOfNeighbour(pair, -toNeighbour, own.w);
    }
    gradient += overlapWeight * foam::overlapGradient(toNeighbour, own.w, other.w);
  }
  return gradient;
}

template <class Real>
FROTH_HD void updateBall(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, uint32_t cell,
                         const glm::vec<4, Real>& gradient, uint32_t& bad) {
  const ParameterPart<Real> point = partOf(foam, Parameter::kPoints, cell);
  const ParameterPart<Real> radius = partOf(foam, Parameter::kRadii, cell);
  for (int c = 0; c < 3; ++c) bad += !updatePart(point, c, gradient[c], adam, Parameter::kPoints);
  const Real slope = foam::softplusSlope(radius.values[0]);
  bad += !updatePart(radius, 0, gradient.w * slope, adam, Parameter::kRadii);
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
