#include "baker/appearance/lobe_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shaders/foam/appearance.h"

namespace froth {
namespace {

// Keeps lobes that are hardly seen near the base: in units of the observations' total weight.
constexpr double kRidge = 1e-3;
constexpr double kSmallestWeightSum = 1e-200;  // below, weights relative to the candidates' largest have underflown

}  // namespace

LobeBasis::LobeBasis(const Observations& seen, std::vector<glm::vec3> axes) : axes_(std::move(axes)) {
  const size_t count = axes_.size();
  exponents_.resize(seen.size() * count);
  weights_.resize(seen.size() * count);
  for (size_t i = 0; i < seen.size(); ++i) {
    float* const exponents = exponents_.data() + i * count;
    for (size_t a = 0; a < count; ++a) exponents[a] = foam::lobeExponent(axes_[a], seen.directions[i]);
    const float largest = count > 0 ? *std::max_element(exponents, exponents + count) : 0;
    for (size_t a = 0; a < count; ++a) weights_[i * count + a] = std::exp(double(exponents[a]) - largest);
  }
}

void LobeBasis::sharesAlong(size_t direction, std::span<const uint32_t> chosen, double* shares) const {
  const size_t row = direction * axes_.size();
  double sum = 0;
  for (size_t l = 0; l < chosen.size(); ++l) sum += shares[l] = weights_[row + chosen[l]];
  if (sum < kSmallestWeightSum) {
    float largest = -std::numeric_limits<float>::max();
    for (uint32_t a : chosen) largest = std::max(largest, exponents_[row + a]);
    sum = 0;
    for (size_t l = 0; l < chosen.size(); ++l) {
      sum += shares[l] = std::exp(double(exponents_[row + chosen[l]]) - largest);
    }
  }
  for (size_t l = 0; l < chosen.size(); ++l) shares[l] /= sum;
}

LobeEquations::LobeEquations(const Observations& seen, const LobeBasis& basis, std::span<const uint32_t> chosen,
                             const glm::dvec3& base)
    : count_(chosen.size()), matrix_(count_ * count_), right_(count_, glm::dvec3(0)) {
  std::vector<double> shares(count_);
  double total = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    basis.sharesAlong(i, chosen, shares.data());
    const double weight = seen.weights[i];
    const glm::dvec3 wanted = glm::dvec3(seen.colours[i]) - base;
    total += weight;
    constant_ += weight * wanted * wanted;
    for (size_t l = 0; l < count_; ++l) {
      const double weighted = weight * shares[l];
      right_[l] += weighted * wanted;
      for (size_t m = 0; m <= l; ++m) matrix_[l * count_ + m] += weighted * shares[m];
    }
  }
  for (size_t l = 0; l < count_; ++l) {
    matrix_[l * count_ + l] += kRidge * total / static_cast<double>(count_);
    for (size_t m = 0; m < l; ++m) matrix_[m * count_ + l] = matrix_[l * count_ + m];
  }
}

// matrix = U^T U; target = U^-T right. |matrix^(1/2) x - ...|^2 = |U x - target|^2.
bool LobeEquations::factorize(std::vector<double>& upper, std::vector<glm::dvec3>& target) const {
  upper = matrix_;
  target = right_;
  for (size_t j = 0; j < count_; ++j) {
    for (size_t i = 0; i <= j; ++i) {
      double sum = matrix_[i * count_ + j];
      for (size_t k = 0; k < i; ++k) sum -= upper[k * count_ + i] * upper[k * count_ + j];
      if (i < j) {
        upper[i * count_ + j] = sum / upper[i * count_ + i];
      } else {
        if (!(sum > 0)) return false;
        upper[j * count_ + j] = std::sqrt(sum);
      }
    }
    for (size_t k = 0; k < j; ++k) target[j] -= upper[k * count_ + j] * target[k];
    target[j] /= upper[j * count_ + j];
  }
  return true;
}

std::vector<glm::dvec3> LobeEquations::solveOnLattice(double step) const {
  std::vector<double> upper;
  std::vector<glm::dvec3> x;
  if (!factorize(upper, x)) return std::vector<glm::dvec3>(count_, glm::dvec3(0));
  for (size_t l = count_; l-- > 0;) {
    for (size_t m = l + 1; m < count_; ++m) x[l] -= upper[l * count_ + m] * x[m];
    x[l] /= upper[l * count_ + l];
    if (step > 0) x[l] = glm::roundEven(x[l] / step) * step;
  }
  return x;
}

std::vector<glm::dvec3> LobeEquations::solve() const { return solveOnLattice(0); }

double LobeEquations::leastError() const {
  std::vector<double> upper;
  std::vector<glm::dvec3> target;
  if (!factorize(upper, target)) return std::numeric_limits<double>::infinity();
  glm::dvec3 error = constant_;
  for (const glm::dvec3& t : target) error -= t * t;
  return std::max(0.0, (error.x + error.y + error.z) / 3);
}

FitError measureFit(const Observations& seen, const LobeBasis& basis, std::span<const uint32_t> chosen,
                    const glm::dvec3& base, std::span<const glm::dvec3> colours) {
  FitError error;
  error.misses.reserve(seen.size());
  std::vector<double> shares(chosen.size());
  for (size_t i = 0; i < seen.size(); ++i) {
    basis.sharesAlong(i, chosen, shares.data());
    glm::dvec3 colour = base;
    for (size_t l = 0; l < chosen.size(); ++l) colour += shares[l] * colours[l];
    const glm::dvec3 miss = glm::max(colour, 0.0) - glm::dvec3(seen.colours[i]);
    error.squared += seen.weights[i] * glm::dot(miss, miss) / 3;
    error.misses.push_back(miss);
  }
  return error;
}

}  // namespace froth
