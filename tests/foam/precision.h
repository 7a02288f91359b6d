// The foam's headers are tested in both precisions in which the CPU compiles them.
#pragma once

#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <limits>
#include <random>

namespace froth {

template <class Real>
class InBothPrecisions : public ::testing::Test {
 protected:
  static constexpr double kEpsilon = std::numeric_limits<Real>::epsilon();

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  glm::dvec3 point(double extent) {
    return {uniform(-extent, extent), uniform(-extent, extent), uniform(-extent, extent)};
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 p = point(1);
      if (glm::length(p) > 0.1 && glm::length(p) < 1) return glm::normalize(p);
    }
  }

 private:
  std::mt19937_64 random_{7};
};

using Precisions = ::testing::Types<float, double>;

}  // namespace froth
