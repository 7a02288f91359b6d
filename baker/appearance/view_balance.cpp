#include "baker/appearance/view_balance.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "baker/appearance/cell_coder.h"
#include "baker/appearance/observations.h"

namespace froth {
namespace {

constexpr int kBalanceRounds = 3;
constexpr uint32_t kSampledCells = 2048;
constexpr uint32_t kTaskCells = 16;  // coded by one task
constexpr double kMostWeight = 8;    // of a view, and its inverse the least

std::vector<double> measureErrors(const Foam& foam, const CellCoder& coder, size_t viewCount) {
  const uint32_t count = std::min(foam.cellCount, kSampledCells);
  std::vector<std::vector<double>> slices((count + kTaskCells - 1) / kTaskCells);
  tbb::parallel_for(size_t{0}, slices.size(), [&](size_t s) {
    slices[s].resize(viewCount);
    const auto first = static_cast<uint32_t>(s) * kTaskCells;
    for (uint32_t i = first; i < std::min(first + kTaskCells, count); ++i) {
      coder.addViewErrors(static_cast<uint32_t>(uint64_t{i} * foam.cellCount / count), slices[s]);
    }
  });
  std::vector<double> errors(viewCount);
  for (const auto& slice : slices) {
    for (size_t v = 0; v < viewCount; ++v) errors[v] += slice[v];
  }
  return errors;
}

}  // namespace

std::vector<float> balanceViews(const Foam& foam, const Visibility& visibility, const AxisCodebook& codebook,
                                const AppearanceOptions& options, const Progress& progress) {
  std::vector<float> weights(visibility.eyes.size(), 1.0f);
  for (int round = 0; round < kBalanceRounds; ++round) {
    if (!report(progress, "views balanced", round, kBalanceRounds)) return {};
    const Observer observer(foam, &visibility, options.eyeRadius, weights);
    std::vector<double> errors = measureErrors(foam, CellCoder(foam, observer, codebook, options), weights.size());
    double mean = 0;
    for (size_t v = 0; v < weights.size(); ++v) {
      errors[v] /= visibility.pixels[v];
      mean += errors[v] / static_cast<double>(weights.size());
    }
    if (!(mean > 0)) break;
    for (size_t v = 0; v < weights.size(); ++v) {
      weights[v] = static_cast<float>(std::clamp(weights[v] * errors[v] / mean, 1 / kMostWeight, kMostWeight));
    }
  }
  return weights;
}

}  // namespace froth
