#include "baker/synth/appearance_fit.h"

#include <algorithm>
#include <cmath>

#include "baker/synth/golden_angle.h"
#include "shaders/foam/appearance.h"

namespace froth {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

constexpr int kDiscSamples = 96;
constexpr int kSpreadRounds = 6;

// Evenly spread over the unit disc (Vogel 1979).
std::vector<dvec2> sampleDisc() {
  std::vector<dvec2> samples(kDiscSamples);
  for (int i = 0; i < kDiscSamples; ++i) {
    const double radius = std::sqrt((i + 0.5) / kDiscSamples), angle = kGoldenAngle * i;
    samples[static_cast<size_t>(i)] = radius * dvec2(std::cos(angle), std::sin(angle));
  }
  return samples;
}

uint32_t findNearest(std::span<const dvec2> places, const dvec2& x) {
  uint32_t nearest = 0;
  for (uint32_t k = 1; k < places.size(); ++k) {
    const dvec2 gap = places[k] - x, best = places[nearest] - x;
    if (glm::dot(gap, gap) < glm::dot(best, best)) nearest = k;
  }
  return nearest;
}

// Solves (A + ridge I) X = B in place of B, A symmetric positive semidefinite [n * n], by Cholesky.
template <class Vector>
void solveRidge(std::vector<double>& a, std::vector<Vector>& b, double ridge) {
  const size_t n = b.size();
  for (size_t j = 0; j < n; ++j) {
    a[j * n + j] += ridge;
    for (size_t k = 0; k < j; ++k) a[j * n + j] -= a[j * n + k] * a[j * n + k];
    const double pivot = std::sqrt(std::max(a[j * n + j], 1e-12));
    a[j * n + j] = pivot;
    for (size_t i = j + 1; i < n; ++i) {
      for (size_t k = 0; k < j; ++k) a[i * n + j] -= a[i * n + k] * a[j * n + k];
      a[i * n + j] /= pivot;
    }
  }
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < i; ++k) b[i] -= a[i * n + k] * b[k];
    b[i] /= a[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; ++k) b[i] -= a[k * n + i] * b[k];
    b[i] /= a[i * n + i];
  }
}

// Adds weight * basis basis^T to A and weight * basis * value to B.
template <class Vector>
void addObservation(std::span<const double> basis, double weight, const Vector& value, std::vector<double>& a,
                    std::vector<Vector>& b) {
  const size_t n = basis.size();
  for (size_t i = 0; i < n; ++i) {
    b[i] += weight * basis[i] * value;
    for (size_t j = 0; j <= i; ++j) a[i * n + j] += weight * basis[i] * basis[j];
  }
}

dvec3 meanColour(std::span<const SeenColour> seen) {
  dvec3 sum(0);
  double total = 0;
  for (const SeenColour& s : seen) {
    sum += s.weight * s.colour;
    total += s.weight;
  }
  return sum / total;
}

void normalizeWeights(std::vector<double>& weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) weight /= sum;
}

}  // namespace

FacePatch spreadDetails(std::span<const dvec3> cuts, uint32_t detailCount) {
  static const std::vector<dvec2> disc = sampleDisc();
  FacePatch patch;
  for (const dvec2& x : disc) {
    const bool own =
        std::all_of(cuts.begin(), cuts.end(), [&](const dvec3& cut) { return cut.x * x.x + cut.y * x.y <= cut.z; });
    if (own) patch.samples.push_back(x);
  }
  if (patch.samples.size() < detailCount) patch.samples = disc;  // a sliver, seen by no one: anything will do

  // k-means, from samples at even strides of the spiral.
  for (size_t k = 0; k < detailCount; ++k) {
    patch.details.push_back(patch.samples[(2 * k + 1) * patch.samples.size() / (2 * detailCount)]);
  }
  patch.nearestDetail.resize(patch.samples.size());
  for (int round = 0; round < kSpreadRounds; ++round) {
    std::vector<dvec3> sums(detailCount, dvec3(0));
    for (size_t s = 0; s < patch.samples.size(); ++s) {
      patch.nearestDetail[s] = findNearest(patch.details, patch.samples[s]);
      sums[patch.nearestDetail[s]] += dvec3(patch.samples[s], 1);
    }
    if (round + 1 == kSpreadRounds) break;
    for (size_t k = 0; k < detailCount; ++k) {
      if (sums[k].z > 0) patch.details[k] = dvec2(sums[k]) / sums[k].z;
    }
  }
  return patch;
}

std::vector<dvec4> fitDetailValues(const FacePatch& patch, std::span<const dvec4> sampleValues, double sharpness) {
  // Held towards the plain means by a weight that only tames what the samples leave undetermined.
  constexpr double kRidge = 0.02;
  const size_t n = patch.details.size();
  std::vector<dvec4> values(n, dvec4(0));
  std::vector<double> counts(n, 0);
  dvec4 mean(0);
  for (size_t s = 0; s < sampleValues.size(); ++s) {
    values[patch.nearestDetail[s]] += sampleValues[s];
    counts[patch.nearestDetail[s]] += 1;
    mean += sampleValues[s] / static_cast<double>(sampleValues.size());
  }
  for (size_t k = 0; k < n; ++k) values[k] = counts[k] > 0 ? values[k] / counts[k] : mean;

  std::vector<double> a(n * n, 0), basis(n);
  std::vector<dvec4> correction(n, dvec4(0));
  for (size_t s = 0; s < sampleValues.size(); ++s) {
    const dvec2& x = patch.samples[s];
    dvec4 residual = sampleValues[s];
    for (size_t k = 0; k < n; ++k) basis[k] = foam::detailWeight(dvec3(x, 0), patch.details[k], sharpness);
    normalizeWeights(basis);
    for (size_t k = 0; k < n; ++k) residual -= basis[k] * values[k];
    addObservation(basis, 1.0, residual, a, correction);
  }
  solveRidge(a, correction, kRidge * static_cast<double>(sampleValues.size()) / static_cast<double>(n));
  for (size_t k = 0; k < n; ++k) values[k] += correction[k];
  return values;
}

std::vector<dvec3> chooseLobeAxes(std::span<const SeenColour> seen, uint32_t lobeCount) {
  constexpr int kRounds = 5;
  constexpr double kEvenShare = 0.3;  // [mean departures] what every direction counts anyway
  constexpr double kHeat = 0.9, kColdest = 1.0,
                   kHottest = 40.0;  // temperature = heat / distance to the next axis
  const dvec3 mean = meanColour(seen);
  double departure = 0, total = 0;
  for (const SeenColour& s : seen) {
    departure += s.weight * glm::length(s.colour - mean);
    total += s.weight;
  }
  const double evenly = kEvenShare * departure / total + 1e-9;

  std::vector<dvec3> axes(lobeCount);
  for (size_t m = 0; m < lobeCount; ++m) axes[m] = seen[m * seen.size() / lobeCount].direction;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<dvec3> sums(lobeCount, dvec3(0));
    for (const SeenColour& s : seen) {
      size_t nearest = 0;
      for (size_t m = 1; m < lobeCount; ++m) {
        if (glm::dot(axes[m], s.direction) > glm::dot(axes[nearest], s.direction)) nearest = m;
      }
      sums[nearest] += s.weight * (glm::length(s.colour - mean) + evenly) * s.direction;
    }
    for (size_t m = 0; m < lobeCount; ++m) {
      if (sums[m] != dvec3(0)) axes[m] = glm::normalize(sums[m]);
    }
  }
  std::vector<dvec3> heated(lobeCount);
  for (size_t m = 0; m < lobeCount; ++m) {
    double gap = 2;
    for (size_t other = 0; other < lobeCount; ++other) {
      if (other != m) gap = std::min(gap, glm::length(axes[m] - axes[other]));
    }
    heated[m] = std::clamp(kHeat / std::max(gap, 1e-6), kColdest, kHottest) * axes[m];
  }
  return heated;
}

std::vector<dvec3> fitLobeColours(std::span<const dvec3> axes, std::span<const SeenColour> seen) {
  constexpr double kRidge = 1e-6;  // of the total weight: lobes that no direction tells apart share their colour
  const size_t n = axes.size();
  const dvec3 mean = meanColour(seen);
  double total = 0;
  std::vector<double> a(n * n, 0), basis(n);
  std::vector<dvec3> colours(n, dvec3(0));
  for (const SeenColour& s : seen) {
    for (size_t m = 0; m < n; ++m) basis[m] = std::exp(foam::lobeExponent(axes[m], s.direction));
    normalizeWeights(basis);
    addObservation(basis, s.weight, s.colour - mean, a, colours);
    total += s.weight;
  }
  solveRidge(a, colours, kRidge * total);
  for (dvec3& colour : colours) colour += mean - 0.5;
  return colours;
}

}  // namespace froth
