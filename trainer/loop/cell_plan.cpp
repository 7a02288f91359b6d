#include "trainer/loop/cell_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "base/counter_random.h"
#include "foam/morton_order.h"
#include "shaders/foam/activations.h"
#include "trainer/step/crowds.h"

namespace froth {
namespace {

constexpr float kLeastShare = 1.0f / 25;  // of what a cell would show if all showed as much
constexpr double kMostRemoved = 0.1;      // of all cells at a time
constexpr double kTrimmedErrors = 0.99;   // errors beyond this share count as that
constexpr float kPart = 0.3f;             // parent and child move by so many radii, ...
constexpr float kMostPart = 0.05f;        // ... and no farther: sites learn 0.1 units at most until cells change again

float quantileOf(std::vector<float> values, double share) {
  const auto place = static_cast<size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(place), values.end());
  return values[place];
}

// Removed are cells that show less than their share, the least first and a tenth of all at most; and any whose numbers
// are not finite.
std::vector<uint32_t> findSurvivors(const CellFacts& facts, uint32_t wanted) {
  const auto cellCount = static_cast<uint32_t>(facts.balls.size());
  const auto isSound = [&](uint32_t i) {
    const glm::vec4& ball = facts.balls[i];
    return std::isfinite(ball.x + ball.y + ball.z + ball.w + facts.contributions[i] + facts.errors[i]);
  };
  std::vector<std::pair<float, uint32_t>> least;
  for (uint32_t i = 0; i < cellCount; ++i) least.emplace_back(isSound(i) ? facts.contributions[i] : -1, i);
  const auto most = static_cast<size_t>(kMostRemoved * cellCount);
  std::nth_element(least.begin(), least.begin() + static_cast<ptrdiff_t>(most), least.end());
  const float limit = kLeastShare / static_cast<float>(wanted);
  std::vector<uint32_t> survivors;
  for (size_t i = 0; i < least.size(); ++i) {
    const auto& [contribution, cell] = least[i];
    if (contribution >= 0 && (i >= most || contribution > limit)) survivors.push_back(cell);
  }
  std::sort(survivors.begin(), survivors.end());
  return survivors;
}

// `count` of the survivors, those with the largest keys ln(u) / weight: drawn by weight, without replacement
// (Efraimidis & Spirakis 2006).
std::vector<uint32_t> drawParents(const CellFacts& facts, const std::vector<uint32_t>& survivors, uint32_t count,
                                  const CounterRandom& random) {
  std::vector<float> errors;
  for (const uint32_t cell : survivors) errors.push_back(facts.errors[cell]);
  const float most = errors.empty() ? 0 : quantileOf(errors, kTrimmedErrors);
  std::vector<std::pair<double, uint32_t>> keys;
  for (const uint32_t cell : survivors) {
    const double weight = std::min(facts.errors[cell], most);
    if (weight > 0) keys.emplace_back(-std::log1p(-random.uniform(cell)) / weight, cell);
  }
  const size_t drawn = std::min<size_t>(count, keys.size());
  std::nth_element(keys.begin(), keys.begin() + static_cast<ptrdiff_t>(drawn), keys.end());
  std::vector<uint32_t> parents;
  for (size_t i = 0; i < drawn; ++i) parents.push_back(keys[i].second);
  std::sort(parents.begin(), parents.end());
  return parents;
}

glm::vec3 stepOnFace(const CellFacts& facts, uint32_t cell, const Eyes& eyes, const CounterRandom& random) {
  glm::vec3 normal, tangent, bitangent;
  foam::frameOfQuaternion(glm::make_vec4(&facts.quaternions[4 * size_t{cell}]), normal, tangent, bitangent);
  const auto angle = static_cast<float>(random.uniform(cell, 0, glm::two_pi<double>()));
  const float length = std::min(kPart * facts.balls[cell].w, kMostPart * unitAt(eyes, facts.balls[cell]));
  return length * (std::cos(angle) * tangent + std::sin(angle) * bitangent);
}

CellPlan sortAlongCurve(const CellFacts& facts, const CellPlan& plan) {
  std::vector<glm::vec3> sites;
  for (size_t i = 0; i < plan.sources.size(); ++i) {
    sites.push_back(glm::vec3(facts.balls[plan.sources[i]]) + plan.changes[i].shift);
  }
  CellPlan sorted;
  for (const uint32_t place : mortonOrder(sites)) {
    sorted.sources.push_back(plan.sources[place]);
    sorted.changes.push_back(plan.changes[place]);
  }
  return sorted;
}

}  // namespace

CellFacts factsOf(const FoamStorage<float>& foam, std::span<const uint32_t> overlaps) {
  return {foam.balls, foam.values[static_cast<size_t>(Parameter::kOrientations)], foam.contributions, foam.errors,
          overlaps};
}

CellPlan planCells(const CellFacts& facts, uint32_t wanted, const Eyes& eyes, uint64_t seed, uint32_t step) {
  const std::vector<uint32_t> survivors = findSurvivors(facts, wanted);
  CellPlan plan;
  plan.sources = survivors;
  for (const uint32_t cell : survivors) {
    plan.changes.push_back({.radiusFactor = shrinkOf(facts.balls.size(), facts.overlaps[cell])});
  }
  const auto count = static_cast<uint32_t>(survivors.size());
  const CounterRandom choice(seed, Purpose::kSplit, uint64_t{2} * step),
      way(seed, Purpose::kSplit, uint64_t{2} * step + 1);
  for (const uint32_t parent : drawParents(facts, survivors, wanted > count ? wanted - count : 0, choice)) {
    const auto place =
        static_cast<size_t>(std::lower_bound(survivors.begin(), survivors.end(), parent) - survivors.begin());
    const glm::vec3 shift = stepOnFace(facts, parent, eyes, way);
    CellChange change{.shift = shift, .meanFactor = 0.5f, .radiusFactor = plan.changes[place].radiusFactor};
    plan.changes[place] = change;
    change.shift = -shift;
    plan.sources.push_back(parent);
    plan.changes.push_back(change);
  }
  return sortAlongCurve(facts, plan);
}

FoamStorage<float> rearrange(const FoamStorage<float>& foam, const CellPlan& plan) {
  FoamStorage<float> next;
  const FoamShape shape{static_cast<uint32_t>(plan.sources.size()), foam.shape.detailCount, foam.shape.lobeCount};
  resizeStorage(next, shape);
  const TrainedFoam<float> view = viewStorage(next);
  tbb::parallel_for(0u, shape.cellCount, [&](uint32_t cell) {
    const uint32_t source = plan.sources[cell];
    for (size_t t = 0; t < kParameterCount; ++t) {
      const size_t width = widthOf(static_cast<Parameter>(t), shape);
      const auto copyRow = [&](const std::vector<float>& from, std::vector<float>& to) {
        std::copy_n(from.begin() + static_cast<ptrdiff_t>(source * width), width,
                    to.begin() + static_cast<ptrdiff_t>(cell * width));
      };
      copyRow(foam.values[t], next.values[t]);
      copyRow(foam.firstMoments[t], next.firstMoments[t]);
      copyRow(foam.secondMoments[t], next.secondMoments[t]);
    }
    next.lastSteps[cell] = foam.lastSteps[source];
    next.contributions[cell] = foam.contributions[source];
    next.errors[cell] = foam.errors[source];
    changeCell(view, cell, plan.changes[cell]);
  });
  return next;
}

}  // namespace froth
