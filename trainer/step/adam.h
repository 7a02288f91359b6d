// Adam (Kingma & Ba 2015) with beta 0.9 and 0.999, and what it does to a parameter that gets no gradient for many
// steps.
//
// Without gradients the moments decay geometrically, so k steps collapse to one: m and v fall by beta1^k and beta2^k,
// and the value moves by -D m / sqrt(v), with D the sum over the steps of rate c rho^j, rho = beta1 / sqrt(beta2). D
// depends on the step from which a parameter waits alone: one table per parameter (DriftTables in trainer/loop/).
#pragma once

#include <cmath>
#include <cstdint>

#include "foam/checkpoint/parameters.h"
#include "trainer/step/host_device.h"

namespace froth {

inline constexpr double kBeta1 = 0.9, kBeta2 = 0.999;

template <class Real>
struct AdamStep {
  uint32_t step = 1;                    // from 1
  Real rates[kParameterCount];          // learning rate times sqrt(1 - beta2^step) / (1 - beta1^step)
  Real epsilon = Real(1e-15);           // times sqrt(1 - beta2^step)
  const Real* drifts[kParameterCount];  // [step] D for parameters that wait since step `index`, up to the step before
};

// A gradient that is no finite number counts as 0; returns whether it was one.
template <class Real>
FROTH_HD bool updateValue(Real& value, Real& firstMoment, Real& secondMoment, Real gradient, Real rate, Real epsilon) {
  const bool isGood = std::isfinite(gradient);
  const Real used = isGood ? gradient : 0;
  firstMoment = Real(kBeta1) * firstMoment + Real(1 - kBeta1) * used;
  secondMoment = Real(kBeta2) * secondMoment + Real(1 - kBeta2) * used * used;
  value -= rate * firstMoment / (std::sqrt(secondMoment) + epsilon);
  return isGood;
}

// Steps without gradient.
template <class Real>
struct Wait {
  Real drift, firstDecay, secondDecay;
};

template <class Real>
FROTH_HD Wait<Real> waitSince(const AdamStep<Real>& adam, Parameter parameter, uint32_t lastStep) {
  const Real skipped = Real(adam.step - 1 - lastStep);
  return {adam.drifts[static_cast<size_t>(parameter)][lastStep], std::pow(Real(kBeta1), skipped),
          std::pow(Real(kBeta2), skipped)};
}

template <class Real>
FROTH_HD void catchUp(Real& value, Real& firstMoment, Real& secondMoment, const Wait<Real>& wait) {
  if (secondMoment > 0) value -= wait.drift * firstMoment / std::sqrt(secondMoment);
  firstMoment *= wait.firstDecay;
  secondMoment *= wait.secondDecay;
}

}  // namespace froth
