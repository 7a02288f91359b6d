#include "measure/sweep/drawing.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/percentiles.h"

namespace froth {
namespace {

constexpr uint32_t kLeastCycles = 3;  // of a round

}  // namespace

Interval intervalOf(const std::vector<double>& cycles) {
  const Percentiles p = percentilesOf(cycles);
  return {p.median, p.p5, p.p95};
}

uint32_t cyclesOf(const Draw& draw, const Rounds& rounds) {
  const auto perCycle = static_cast<uint32_t>(draw.views.size()) * rounds.count;
  return std::max(kLeastCycles, (rounds.frames + perCycle - 1) / perCycle);
}

std::vector<size_t> orderOf(const std::vector<Draw>& draws, const Rounds& rounds, uint32_t round) {
  std::vector<std::string> loads;
  for (const Draw& draw : draws) loads.push_back(fmt::format("{} {}", draw.asset.string(), draw.layers));
  return orderOfRound(loads, rounds.seed, round);
}

}  // namespace froth
