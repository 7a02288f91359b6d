// Ticks and numbers of plots.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measure/report/svg_plot.h"
#include "measure/report/text.h"

namespace froth {
namespace {

// With the decimals of the step, so that neighbouring ticks read differently.
std::string tickLabel(double value, double step) {
  const double size = std::abs(value);
  if (size >= 1e5 || (size > 0 && size < 1e-3)) return shortNumber(value);
  const int decimals = std::max(0, -int(std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{}{:.{}f}", value < 0 ? "−" : "", size, decimals);
}

// Of a digit times a power of ten, which needs no zeros behind it: "0.01", "2e-4".
std::string roundLabel(double value) {
  if (value >= 0.9e-3 && value < 0.9e6) return fmt::format("{:.6g}", value);
  const int decade = int(std::floor(std::log10(value) + 1e-9));
  return fmt::format("{:.0f}e{}", value / std::pow(10, decade), decade);
}

std::vector<PlotTick> linearTicks(double from, double to, int most) {
  const double least = (to - from) / std::max(most - 1, 1);
  const double decade = std::pow(10, std::floor(std::log10(least)));
  double step = decade;
  for (double factor : {1.0, 2.0, 5.0, 10.0}) {
    step = factor * decade;
    if (step >= least * (1 - 1e-9)) break;
  }
  std::vector<PlotTick> ticks;
  // By whole steps, so that 0 is 0 and rounding does not grow.
  for (double k = std::ceil(from / step - 1e-9); k * step <= to + step * 1e-9; ++k) {
    ticks.push_back({k * step, tickLabel(k * step, step)});
  }
  return ticks;
}

std::vector<PlotTick> logarithmicTicks(double from, double to, int most) {
  const int first = int(std::ceil(std::log10(from) - 1e-9)), last = int(std::floor(std::log10(to) + 1e-9));
  const auto fillDecades = [&](const std::vector<double>& factors, int every) {
    std::vector<PlotTick> ticks;
    for (int decade = first - 1; decade <= last; ++decade) {
      if (every > 1 && decade % every != 0) continue;
      for (double factor : factors) {
        const double value = factor * std::pow(10, decade);
        if (value >= from * (1 - 1e-9) && value <= to * (1 + 1e-9)) ticks.push_back({value, roundLabel(value)});
      }
    }
    return ticks;
  };
  const std::vector<std::vector<double>> choices{{1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 5, 7}, {1, 2, 5}, {1, 3}, {1}};
  for (const std::vector<double>& factors : choices) {
    std::vector<PlotTick> ticks = fillDecades(factors, 1);
    if (int(ticks.size()) <= most && ticks.size() >= 2) return ticks;
  }
  // Less than a decade without two round values in it, or many decades.
  if (last - first < 2) return linearTicks(from, to, most);
  return fillDecades({1}, (last - first) / std::max(most - 1, 1) + 1);
}

}  // namespace

std::vector<PlotTick> chooseTicks(double from, double to, bool isLogarithmic, int most) {
  if (!(to > from) || !std::isfinite(from) || !std::isfinite(to)) return {{from, shortNumber(from)}};
  return isLogarithmic && from > 0 ? logarithmicTicks(from, to, most) : linearTicks(from, to, most);
}

}  // namespace froth
