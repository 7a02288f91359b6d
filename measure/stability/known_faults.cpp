#include "measure/stability/known_faults.h"

#include <algorithm>

#include <fmt/format.h>

namespace froth {
namespace {

constexpr double kFactorSlack = 2;  // devices round in different ways

bool isThat(const KnownFault& known, const SeenFault& seen) {
  return known.preset == seen.preset && known.renderer == seen.renderer && known.kind == seen.kind &&
         seen.factor <= kFactorSlack * known.factor && known.factor <= kFactorSlack * seen.factor;
}

}  // namespace

std::vector<std::string> unexplainedFaults(const std::vector<KnownFault>& known, const std::vector<SeenFault>& seen) {
  std::vector<std::string> lines;
  for (const SeenFault& fault : seen) {
    if (std::none_of(known.begin(), known.end(), [&](const KnownFault& one) { return isThat(one, fault); })) {
      lines.push_back(fault.text);
    }
  }
  for (const KnownFault& one : known) {
    if (std::any_of(seen.begin(), seen.end(), [&](const SeenFault& fault) { return isThat(one, fault); })) continue;
    lines.push_back(
        fmt::format("{}, {}: {} by a factor of {:.3g} is known but not seen; if it is mended, take it out of the case",
                    one.preset, one.renderer, one.kind, one.factor));
  }
  return lines;
}

}  // namespace froth
