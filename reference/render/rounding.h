// Monte Carlo arithmetic (Parker, "Monte Carlo Arithmetic", 1997): what rounding errors would do to an image, by
// putting random ones in. See ReferenceOptions::rounding.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "base/counter_random.h"

namespace froth {

// The errors of one cell, each drawn once. Relative 0 leaves every value as it is.
class Rounding {
 public:
  Rounding(double relative, uint64_t seed, uint32_t cell)
      : relative_(relative), random_(seed, Purpose::kRounding, cell) {}
  // Of what two cells share.
  Rounding(double relative, uint64_t seed, uint32_t cell, uint32_t other) : Rounding(relative, seed, cell) {
    next_ = kMostShared * other;
  }

  // `value` with an absolute error of up to relative * magnitude.
  template <class Real>
  Real of(Real value, Real magnitude) {
    if (relative_ == 0) return value;
    return value + static_cast<Real>(relative_ * random_.uniform(next_++, -1, 1)) * magnitude;
  }
  template <class Real>
  Real of(Real value) {
    return of(value, value);
  }
  // Components err by the length: sums mix them.
  template <class Real>
  glm::vec<3, Real> of(const glm::vec<3, Real>& vector) {
    if (relative_ == 0) return vector;
    const Real length = glm::length(vector);
    return {of(vector.x, length), of(vector.y, length), of(vector.z, length)};
  }

 private:
  static constexpr uint64_t kMostShared = 4;  // values of a pair

  double relative_;
  CounterRandom random_;
  uint64_t next_ = 0;
};

}  // namespace froth
