// Gradients of every raw parameter against differences, in double, and in float against double (design: training.md
// 10).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/reference/scenes.h"
#include "tests/trainer/ray_probe.h"
#include "trainer/cpu/foam_exchange.h"

namespace froth {
namespace {

struct Case {
  const char* name;
  uint32_t detailCount, lobeCount;
  bool isEyeInside;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

struct Entry {
  size_t tensor;
  double found, expected;
};

class Gradients : public ::testing::TestWithParam<Case> {
 protected:
  static constexpr uint32_t kCells = 10;
  static constexpr int kRays = 1000;  // of each case

  FoamStorage<double> makeFoam(uint64_t seed) {
    FoamStorage<double> foam =
        storeFoam<double>(randomFoam(kCells, GetParam().detailCount, GetParam().lobeCount, seed));
    // Quaternions of any length, and sites off the grid, where no two planes are met at once.
    for (double& value : foam.values[size_t(Parameter::kOrientations)]) value *= 1.7;
    for (double& value : foam.values[size_t(Parameter::kPoints)]) value += uniform(-0.03, 0.03);
    return foam;
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  ProbeRay makeRay() {
    const double extent = GetParam().isEyeInside ? 0.4 : 3;
    glm::dvec3 eye(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    eye = extent * glm::normalize(eye);
    const glm::dvec3 target(uniform(-0.8, 0.8), uniform(-0.8, 0.8), uniform(-0.8, 0.8));
    return {eye, glm::normalize(target - eye)};
  }

  ProbeLoss makeLoss() {
    return {{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, uniform(-1, 1), uniform(0, 1), uniform(0, 0.1)};
  }

  std::mt19937_64 random_{11};
};

// Differences of fourth order of one value; false: the loss has a kink within them.
bool differentiateNumerically(RayProbe<double>& probe, const ProbeRay& ray, const ProbeLoss& loss, uint64_t branches,
                              double h, double& value, double& slope) {
  const double middle = value;
  double sum = 0;
  bool isSmooth = true;
  for (const auto& [offset, weight] : {std::pair{-2, 1.0}, {-1, -8.0}, {1, 8.0}, {2, -1.0}}) {
    value = middle + offset * h;
    const ProbeResult result = probe.look(ray, loss);
    isSmooth = isSmooth && result.branches == branches;
    sum += weight * result.loss;
  }
  value = middle;
  slope = sum / (12 * h);
  return isSmooth;
}

// The worst error relative to the value, or where it is small to a part of what values of that parameter are like;
// never to less than `least`, of losses of about 1.
double worstError(const std::vector<Entry>& entries, double partOfTypical, double least) {
  std::array<double, kParameterCount> squares{}, counts{};
  for (const Entry& entry : entries) {
    squares[entry.tensor] += entry.expected * entry.expected;
    counts[entry.tensor] += 1;
  }
  double worst = 0;
  for (const Entry& entry : entries) {
    const double typical = std::sqrt(squares[entry.tensor] / counts[entry.tensor]);
    const double size = std::max({std::abs(entry.expected), partOfTypical * typical, least});
    worst = std::max(worst, std::abs(entry.found - entry.expected) / size);
  }
  return worst;
}

TEST_P(Gradients, OfEveryParameterEqualDifferencesInDouble) {
  std::vector<Entry> entries;
  int kinks = 0, held = 0;
  FoamStorage<double> foam;
  for (int i = 0; i < kRays; ++i) {
    if (i % 25 == 0) foam = makeFoam(100 + static_cast<uint64_t>(i));
    RayProbe<double> probe(foam);
    const ProbeRay ray = makeRay();
    const ProbeLoss loss = makeLoss();
    const auto gradients = probe.differentiate(ray, loss);
    const ProbeResult middle = probe.look(ray, loss);
    held += middle.isHeld;
    // A ray that grazes a ball sees it shrink like a root: there differences need short steps.
    const double step = 2e-5, steep = std::min(middle.leastBallCosine / 0.1, 1.0);
    if (middle.isHeld) continue;
    for (size_t t = 0; t < kParameterCount; ++t) {
      const uint32_t width = widthOf(static_cast<Parameter>(t), foam.shape);
      for (int draw = 0; draw < 4; ++draw) {
        const bool isMet = !middle.metCells.empty() && draw < 3;
        const size_t cell = isMet ? middle.metCells[random_() % middle.metCells.size()] : random_() % kCells;
        const size_t place = cell * width + random_() % width;
        Entry entry{t, gradients[t][place], 0};
        const bool isOfBall = t == size_t(Parameter::kPoints) || t == size_t(Parameter::kRadii);
        const double h = isOfBall ? step * steep * steep : step;
        if (differentiateNumerically(probe, ray, loss, middle.branches, h, foam.values[t][place], entry.expected)) {
          entries.push_back(entry);
        } else {
          ++kinks;
        }
      }
    }
  }
  const double worst = worstError(entries, 0.01, 1e-4);
  EXPECT_LE(worst, 1e-5);
  EXPECT_LE(kinks, 0.001 * static_cast<double>(entries.size()) + 2);
  EXPECT_LE(held, kRays / 50);
  RecordProperty("entries", static_cast<int>(entries.size()));
  RecordProperty("worstPerBillion", static_cast<int>(1e9 * worst));
  RecordProperty("kinks", kinks);
  RecordProperty("held", held);
}

TEST_P(Gradients, InFloatEqualThoseInDouble) {
  std::vector<Entry> entries;
  int skipped = 0;
  for (int i = 0; i < kRays; ++i) {
    FoamStorage<double> foam = makeFoam(100 + static_cast<uint64_t>(i));
    FoamStorage<float> rounded;
    resizeStorage(rounded, foam.shape);
    for (size_t t = 0; t < kParameterCount; ++t) {
      rounded.values[t].assign(foam.values[t].begin(), foam.values[t].end());
      foam.values[t].assign(rounded.values[t].begin(), rounded.values[t].end());
    }
    RayProbe<double> probe(foam);
    RayProbe<float> floatProbe(rounded);
    ProbeRay ray = makeRay();
    ray = {glm::dvec3(glm::vec3(ray.eye)), glm::dvec3(glm::vec3(ray.direction))};
    const ProbeLoss loss = makeLoss();
    const ProbeResult exact = probe.look(ray, loss);
    if (exact.isHeld || exact.branches != floatProbe.look(ray, loss).branches) {
      ++skipped;
      continue;
    }
    const auto expected = probe.differentiate(ray, loss);
    const auto found = floatProbe.differentiate(ray, loss);
    for (size_t t = 0; t < kParameterCount; ++t) {
      for (size_t j = 0; j < expected[t].size(); ++j) {
        if (expected[t][j] != 0) entries.push_back({t, found[t][j], expected[t][j]});
      }
    }
  }
  const double worst = worstError(entries, 0.1, 1e-3);
  EXPECT_LE(worst, 1e-2);
  RecordProperty("worstPerBillion", static_cast<int>(1e9 * worst));
  EXPECT_LE(skipped, kRays / 25);
}

INSTANTIATE_TEST_SUITE_P(Foams, Gradients,
                         ::testing::Values(Case{"OneDetailOneLobe", 1, 1, false}, Case{"ThreeOfThree", 3, 3, false},
                                           Case{"EightOfEight", 8, 8, false}, Case{"EyeInside", 3, 3, true}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace froth
