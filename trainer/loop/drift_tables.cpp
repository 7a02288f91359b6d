#include "trainer/loop/drift_tables.h"

#include <algorithm>
#include <cmath>

namespace froth {
namespace {

// step: from 1.
double correctionAt(uint32_t step) { return std::sqrt(1 - std::pow(kBeta2, step)) / (1 - std::pow(kBeta1, step)); }

}  // namespace

void DriftTables::advance() {
  const double position = pace_.positionAt(next_);
  const uint32_t count = ++next_;  // the step's number from 1
  const double rho = kBeta1 / std::sqrt(kBeta2);
  for (size_t i = 0; i < kParameterCount; ++i) {
    double part = rateAt(pace_.schedule(), static_cast<Parameter>(i), position) * correctionAt(count);
    for (uint32_t waited = 1; waited <= std::min(count, kLongestDrift); ++waited) {
      part *= rho;
      double& drift = drifts_[i][count - waited];
      drift += part;
      rounded_[i][count - waited] = static_cast<float>(drift);
    }
  }
}

AdamStep<float> DriftTables::adamAt(uint32_t step) {
  for (std::vector<double>& table : drifts_) table.resize(size_t{step} + 1);
  for (std::vector<float>& table : rounded_) table.resize(size_t{step} + 1);
  while (next_ < step) advance();
  AdamStep<float> adam;
  adam.step = step + 1;
  adam.eyes = eyes_;
  adam.epsilon = static_cast<float>(kEpsilon * std::sqrt(1 - std::pow(kBeta2, adam.step)));
  for (size_t i = 0; i < kParameterCount; ++i) {
    const double rate = rateAt(pace_.schedule(), static_cast<Parameter>(i), pace_.positionAt(step));
    adam.rates[i] = static_cast<float>(rate * correctionAt(adam.step));
    adam.drifts[i] = rounded_[i].data();
  }
  return adam;
}

}  // namespace froth
