// Adam (Kingma & Ba 2015) with beta 0.9 and 0.999, and what it does to a parameter that gets no gradient for many
// steps.
//
// Without gradients the moments decay geometrically, so k steps collapse to one: m and v fall by beta1^k and beta2^k,
// and the value moves by -D m / (sqrt(v) + epsilon), with D the sum over the steps of rate c rho^j, rho = beta1 /
// sqrt(beta2). D depends on the step from which a parameter waits alone: one table per parameter (DriftTables in
// trainer/loop/). This epsilon is that of the first step of the wait. Dense Adam's grows with the step, and
// moves such a value by less: 2.2 times less in a wait since step 1, 5 % since step 100, and only where sqrt(v) is not
// far above 1e-15.
#pragma once

#include <cmath>
#include <cstdint>

#include "foam/checkpoint/parameters.h"
#include "trainer/step/eyes.h"
#include "trainer/step/host_device.h"

namespace froth {

inline constexpr double kBeta1 = 0.9, kBeta2 = 0.999, kEpsilon = 1e-15;

template <class Real>
struct AdamStep {
  uint32_t step = 1;                 // from 1
  Real rates[kParameterCount] = {};  // learning rate times sqrt(1 - beta2^step) / (1 - beta1^step)
  Real epsilon = Real(kEpsilon);     // times sqrt(1 - beta2^step)
  // [step] D for parameters that wait since step `index`, up to the step before
  const Real* drifts[kParameterCount] = {};
  Eyes eyes;  // rates and drifts are for cells near them: rateFactor()
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

// Steps without gradient, of all parameters of a cell that wait.
template <class Real>
struct Wait {
  bool isNone = true;
  uint32_t lastStep = 0;  // before them
  Real firstDecay = 1, secondDecay = 1, epsilon = 1;
};

// Up to the step before adam.step.
template <class Real>
FROTH_HD Wait<Real> waitSince(const AdamStep<Real>& adam, uint32_t lastStep) {
  if (lastStep + 1 >= adam.step) return {};
  const Real skipped = Real(adam.step - 1 - lastStep);
  const Real epsilon = Real(kEpsilon) * std::sqrt(1 - std::pow(Real(kBeta2), Real(lastStep + 1)));
  return {false, lastStep, std::pow(Real(kBeta1), skipped), std::pow(Real(kBeta2), skipped), epsilon};
}

}  // namespace froth
