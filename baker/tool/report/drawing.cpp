#include "baker/tool/report/drawing.h"

#include <algorithm>

#include "samples/host/percentiles.h"

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

}  // namespace froth
