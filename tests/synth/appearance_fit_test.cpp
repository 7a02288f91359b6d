#include "baker/synth/appearance_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/counter_random.h"
#include "shaders/foam/appearance.h"

namespace froth {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

constexpr double kSharpness = 10;

dvec4 blend(const std::vector<dvec2>& details, const std::vector<dvec4>& values, const dvec2& x) {
  dvec4 sum(0);
  double weights = 0;
  for (size_t k = 0; k < details.size(); ++k) {
    const double weight = foam::detailWeight(dvec3(x, 0), details[k], kSharpness);
    sum += weight * values[k];
    weights += weight;
  }
  return sum / weights;
}

TEST(SpreadDetails, StaysOnTheOwnSideOfEveryCut) {
  const std::vector<dvec3> cuts = {{1, 0, 0.2}, {-1, 1, 0.3}};
  const FacePatch patch = spreadDetails(cuts, 8);
  ASSERT_EQ(patch.details.size(), 8u);
  for (const dvec2& x : patch.details) {
    for (const dvec3& cut : cuts) EXPECT_LE(cut.x * x.x + cut.y * x.y, cut.z);
  }
}

TEST(SpreadDetails, GivesDistinctSitesEvenWhereNothingIsLeft) {
  const FacePatch patch = spreadDetails(std::vector<dvec3>{{1, 0, -2}}, 8);
  ASSERT_EQ(patch.details.size(), 8u);
  for (size_t a = 0; a < 8; ++a) {
    for (size_t b = 0; b < a; ++b) EXPECT_GT(glm::length(patch.details[a] - patch.details[b]), 0.1);
  }
}

TEST(FitDetailValues, BlendsCloserToTheSamplesThanTheirMeansDo) {
  const FacePatch patch = spreadDetails({}, 8);
  std::vector<dvec4> samples;
  for (const dvec2& x : patch.samples) samples.emplace_back(std::sin(5 * x.x), std::cos(4 * x.y), x.x > 0.1, x.y);
  std::vector<dvec4> means(8, dvec4(0));
  std::vector<double> counts(8, 0);
  for (size_t s = 0; s < samples.size(); ++s) {
    means[patch.nearestDetail[s]] += samples[s];
    counts[patch.nearestDetail[s]] += 1;
  }
  for (size_t k = 0; k < 8; ++k) means[k] /= counts[k];
  const std::vector<dvec4> fitted = fitDetailValues(patch, samples, kSharpness);
  double fittedError = 0, meansError = 0;
  for (size_t s = 0; s < samples.size(); ++s) {
    const dvec4 a = blend(patch.details, fitted, patch.samples[s]) - samples[s];
    const dvec4 b = blend(patch.details, means, patch.samples[s]) - samples[s];
    fittedError += glm::dot(a, a);
    meansError += glm::dot(b, b);
  }
  EXPECT_LT(fittedError, 0.9 * meansError);
}

TEST(FitLobeColours, FindsTheColoursThatMadeThePicture) {
  const CounterRandom random(3, Purpose::kDirection);
  std::vector<dvec3> axes, colours;
  for (uint64_t m = 0; m < 4; ++m) {
    axes.push_back(3.0 * random.direction(m));
    colours.emplace_back(random.uniform(10 * m) - 0.4, random.uniform(10 * m + 1) - 0.4,
                         random.uniform(10 * m + 2) - 0.4);
  }
  std::vector<SeenColour> seen;
  for (uint64_t i = 0; i < 100; ++i) {
    const dvec3 direction = random.direction(100 + i);
    double largest = foam::lobeExponent(axes[0], direction), weights = 0;
    dvec3 sum(0);
    for (size_t m = 0; m < axes.size(); ++m) {
      foam::addLobe(foam::lobeExponent(axes[m], direction), colours[m], largest, weights, sum);
    }
    seen.push_back({direction, sum / weights + 0.5, 1.0});
  }
  const std::vector<dvec3> fitted = fitLobeColours(axes, seen);
  for (size_t m = 0; m < axes.size(); ++m) EXPECT_LT(glm::length(fitted[m] - colours[m]), 0.01) << "lobe " << m;
}

TEST(ChooseLobeAxes, GathersAroundAHighlight) {
  const dvec3 highlight = glm::normalize(dvec3(0.3, 0.2, 1));
  const CounterRandom random(4, Purpose::kDirection);
  std::vector<SeenColour> seen;
  for (uint64_t i = 0; i < 400; ++i) {
    const dvec3 direction = random.direction(i);
    seen.push_back({direction, dvec3(0.2 + 0.8 * (glm::dot(direction, highlight) > 0.9)), 1.0});
  }
  const std::vector<dvec3> axes = chooseLobeAxes(seen, 8);
  double nearest = 2;
  for (const dvec3& axis : axes) nearest = std::min(nearest, glm::length(glm::normalize(axis) - highlight));
  EXPECT_LT(nearest, 0.35);
}

}  // namespace
}  // namespace froth
