// By how much parameters that wait drift (trainer/step/adam.h): one table per parameter, one entry per step from which
// a cell may wait.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trainer/loop/pace.h"
#include "trainer/step/adam.h"

namespace froth {

// A step changes no entries but the last so many: after them the rest of the sum is below 1e-11 of it, rho^256.
inline constexpr uint32_t kLongestDrift = 256;

class DriftTables {
 public:
  explicit DriftTables(const Pace& pace, const Eyes& eyes = {})
      : pace_(pace), eyes_(eyes) {}  // keeps a reference to pace

  // Adam of a step, up to the one that comes next, and never of one before the last that was asked for. Points into the
  // tables, until the next call.
  AdamStep<float> adamAt(uint32_t step);

 private:
  void advance();  // by the rates of step `next_`

  const Pace& pace_;
  Eyes eyes_;
  uint32_t next_ = 0;
  std::array<std::vector<double>, kParameterCount> drifts_;
  std::array<std::vector<float>, kParameterCount> rounded_;
};

}  // namespace froth
