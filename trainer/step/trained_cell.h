// A cell in training as a step finds it. Parameters that wait are stored as the last step left them that showed the
// cell, and read as dense Adam would have them by now (adam.h). Reading stores nothing; Adam's step catches up first.
#pragma once

#include <glm/glm.hpp>

#include "trainer/step/adam.h"
#include "trainer/step/trained_foam.h"

namespace froth {

// Whether a parameter waits while no pixel shows its cell.
FROTH_HD bool isWaiting(Parameter parameter) {
  return parameter != Parameter::kPoints && parameter != Parameter::kRadii;
}

template <class Real>
struct TrainedValue {
  Real value, firstMoment, secondMoment;
};

// Values of one parameter of one cell, or a part of them.
template <class Real>
struct ParameterPart {
  Real *values, *firstMoments, *secondMoments;
  Wait<Real> wait;
  Real drift;          // over the wait
  Real rate, epsilon;  // of Adam's step

  FROTH_HD TrainedValue<Real> stored(uint32_t i) const { return {values[i], firstMoments[i], secondMoments[i]}; }
  // What it is by now.
  FROTH_HD TrainedValue<Real> catchUp(const TrainedValue<Real>& last) const {
    const Real moved = drift == 0 ? 0 : drift * last.firstMoment / (std::sqrt(last.secondMoment) + wait.epsilon);
    return {last.value - moved, wait.firstDecay * last.firstMoment, wait.secondDecay * last.secondMoment};
  }
  FROTH_HD TrainedValue<Real> load(uint32_t i) const { return catchUp(stored(i)); }
  FROTH_HD Real read(uint32_t i) const { return drift == 0 ? values[i] : load(i).value; }
  FROTH_HD glm::vec<3, Real> readThree(uint32_t i) const { return {read(i), read(i + 1), read(i + 2)}; }
  FROTH_HD void store(uint32_t i, const TrainedValue<Real>& trained) const {
    values[i] = trained.value;
    firstMoments[i] = trained.firstMoment;
    secondMoments[i] = trained.secondMoment;
  }
  // Adam's step from what load() gave; returns what updateValue() does.
  FROTH_HD bool update(uint32_t i, TrainedValue<Real> trained, Real gradient) const {
    const bool isGood = updateValue(trained.value, trained.firstMoment, trained.secondMoment, gradient, rate, epsilon);
    store(i, trained);
    return isGood;
  }
  FROTH_HD bool update(uint32_t i, Real gradient) const { return update(i, load(i), gradient); }
};

// Of a rate: lengths count in the unit at the cell, and densities in one per unit.
template <class Real>
FROTH_HD Real rateFactor(Parameter parameter, const Eyes& eyes, const glm::vec<4, Real>& ball) {
  switch (parameter) {
    case Parameter::kPoints:
    case Parameter::kRadii:
      return unitAt(eyes, ball);
    case Parameter::kDensity:
      return 1 / unitAt(eyes, ball);
    default:
      return 1;
  }
}

template <class Real>
FROTH_HD ParameterPart<Real> partOf(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam, const Wait<Real>& wait,
                                    Parameter parameter, uint32_t cell, uint32_t first = 0) {
  const auto index = static_cast<size_t>(parameter);
  const Real factor = rateFactor(parameter, adam.eyes, foam.balls[cell]);
  return {foam.values.row(parameter, foam.shape, cell) + first,
          foam.firstMoments.row(parameter, foam.shape, cell) + first,
          foam.secondMoments.row(parameter, foam.shape, cell) + first,
          wait,
          wait.isNone ? Real(0) : factor * adam.drifts[index][wait.lastStep],
          factor * adam.rates[index],
          adam.epsilon};
}

// The parameters of a cell that wait.
template <class Real>
struct TrainedCell {
  const TrainedFoam<Real>& foam;
  const AdamStep<Real>& adam;
  uint32_t cell;
  Wait<Real> wait;

  FROTH_HD TrainedCell(const TrainedFoam<Real>& itsFoam, const AdamStep<Real>& step, uint32_t index)
      : foam(itsFoam), adam(step), cell(index), wait(waitSince(step, itsFoam.lastSteps[index])) {}

  FROTH_HD ParameterPart<Real> part(Parameter parameter, uint32_t first = 0) const {
    return partOf(foam, adam, wait, parameter, cell, first);
  }
};

}  // namespace froth
