#include "baker/appearance/site_coder.h"

#include <algorithm>

#include "baker/appearance/lobe_selection.h"
#include "format/quantization.h"

namespace froth {
namespace {

constexpr double kBrightestLobe = 2;  // [display-coded] largest offset of a lobe from the base

bool isListed(const std::vector<glm::vec3>& axes, const glm::vec3& axis) {
  return std::find(axes.begin(), axes.end(), axis) != axes.end();
}

glm::dvec3 snapColour(const glm::dvec3& colour, double step) {
  return {snapToStep(colour.x, step), snapToStep(colour.y, step), snapToStep(colour.z, step)};
}

}  // namespace

std::vector<glm::vec3> SiteCoder::candidates(std::span<const glm::vec3> axes, AxisChoice choice) const {
  std::vector<glm::vec3> candidates;
  for (const glm::vec3& axis : axes) {
    glm::vec3 entry(0);
    if (!codebook_.isEmpty()) entry = codebook_.entries()[codebook_.findNearest(axis)];
    if (choice == AxisChoice::kResiduals) entry += snapAxis(axis - entry, options_.lobeAxisStep);
    if (!isListed(candidates, entry)) candidates.push_back(entry);
  }
  return candidates;
}

CodedSite SiteCoder::code(const Observations& seen, std::span<const glm::vec3> axes, double step) const {
  CodedSite best;
  best.base = snapColour(meanColour(seen) - 0.5, step);
  best.error = measureFit(seen, LobeBasis(seen, {}), {}, best.base + 0.5, {});
  if (best.error.squared > bound_ && !codebook_.isEmpty()) {
    tryLobes(seen, LobeBasis(seen, candidates(axes, AxisChoice::kEntries)), step, best);
  }
  if (best.error.squared > bound_ && (codebook_.isEmpty() || options_.lobeAxisStep > 0)) {
    tryLobes(seen, LobeBasis(seen, candidates(axes, AxisChoice::kResiduals)), step, best);
  }
  return best;
}

void SiteCoder::tryLobes(const Observations& seen, const LobeBasis& basis, double step, CodedSite& best) const {
  const glm::dvec3 base = best.base + 0.5;
  LobeSelection selection(seen, basis, base);
  while (selection.chosen().size() < options_.lobeLimit && selection.grow()) {
    const auto& chosen = selection.chosen();
    const bool isLast = chosen.size() == std::min<size_t>(options_.lobeLimit, basis.axes().size());
    if (selection.leastError() > bound_ && !isLast) continue;
    auto colours = LobeEquations(seen, basis, chosen, base).solveOnLattice(step);
    for (glm::dvec3& colour : colours) colour = glm::clamp(colour, -kBrightestLobe, kBrightestLobe);
    FitError error = measureFit(seen, basis, chosen, base, colours);
    if (error.squared >= best.error.squared) continue;
    best.error = std::move(error);
    best.colours = std::move(colours);
    best.axes.clear();
    for (uint32_t a : chosen) best.axes.push_back(basis.axes()[a]);
    if (best.error.squared <= bound_) return;
  }
}

}  // namespace froth
