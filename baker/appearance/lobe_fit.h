// Least-squares colours for given lobe axes: shares of lobes along directions, normal equations, rounding.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/appearance/observations.h"

namespace froth {

// The candidates for the lobes of one detail site, and how much each says along each observed direction.
class LobeBasis {
 public:
  LobeBasis(const Observations& seen, std::vector<glm::vec3> axes);

  const std::vector<glm::vec3>& axes() const { return axes_; }
  // Shares w / sum w of the chosen candidates along direction i; they sum to 1. `shares` has room for
  // chosen.size().
  void sharesAlong(size_t direction, std::span<const uint32_t> chosen, double* shares) const;

 private:
  std::vector<glm::vec3> axes_;
  std::vector<float> exponents_;  // [directions * axes]
  std::vector<double> weights_;   // [directions * axes] exp(exponent - the direction's largest)
};

// min over x of sum_i w_i |sum_l share_il x_l - (colour_i - base)|^2 + ridge |x|^2, three channels at once.
class LobeEquations {
 public:
  LobeEquations(const Observations& seen, const LobeBasis& basis, std::span<const uint32_t> chosen,
                const glm::dvec3& base);

  std::vector<glm::dvec3> solve() const;
  // The same on multiples of step: rounds one lobe after the other, and each makes up for the error of those
  // before it.
  std::vector<glm::dvec3> solveOnLattice(double step) const;
  // Sum of squared errors at the solution without a lattice and without the clamp to 0, mean over channels.
  double leastError() const;

 private:
  bool factorize(std::vector<double>& upper, std::vector<glm::dvec3>& target) const;

  size_t count_;
  std::vector<double> matrix_;     // [count * count] symmetric
  std::vector<glm::dvec3> right_;  // [count]
  glm::dvec3 constant_{0};         // sum of w colour^2
};

struct FitError {
  double squared = 0;             // weighted sum of squared errors, mean over channels
  std::vector<glm::vec3> misses;  // [observations] shown - wanted
};

// Error of base colour + lobes, as a renderer shows them.
FitError measureFit(const Observations& seen, const LobeBasis& basis, std::span<const uint32_t> chosen,
                    const glm::dvec3& base, std::span<const glm::dvec3> colours);

}  // namespace froth
