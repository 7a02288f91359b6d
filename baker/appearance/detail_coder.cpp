#include "baker/appearance/detail_coder.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "baker/appearance/lobe_selection.h"
#include "format/quantization.h"

namespace froth {
namespace {

constexpr double kBrightestLobe = 2;    // [display-coded] largest offset of a lobe from the base
constexpr double kResidualPrice = 0.4;  // of an axis that is no entry of the codebook, relative to the lobe

glm::dvec3 snapColour(const glm::dvec3& colour, double step) {
  return {snapToStep(colour.x, step), snapToStep(colour.y, step), snapToStep(colour.z, step)};
}

std::vector<glm::dvec3> fitColours(const Observations& seen, const LobeBasis& basis, std::span<const uint32_t> chosen,
                                   const glm::dvec3& base, double step) {
  auto colours = LobeEquations(seen, basis, chosen, base).solveOnLattice(step);
  for (glm::dvec3& colour : colours) colour = glm::clamp(colour, -kBrightestLobe, kBrightestLobe);
  return colours;
}

}  // namespace

// Ascending by codebook entry.
std::vector<glm::vec3> DetailCoder::candidates(std::span<const glm::vec3> axes, AxisChoice choice) const {
  std::vector<std::pair<uint32_t, glm::vec3>> labelled;
  for (const glm::vec3& axis : axes) {
    const uint32_t label = codebook_.isEmpty() ? 0 : codebook_.findNearest(axis);
    const glm::vec3 entry = codebook_.isEmpty() ? glm::vec3(0) : codebook_.entries()[label];
    const bool hasResidual = choice == AxisChoice::kResiduals;
    labelled.emplace_back(label, hasResidual ? entry + snapAxis(axis - entry, options_.lobeAxisStep) : entry);
  }
  std::stable_sort(labelled.begin(), labelled.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<glm::vec3> candidates;
  for (const auto& [label, axis] : labelled) {
    if (std::find(candidates.begin(), candidates.end(), axis) == candidates.end()) candidates.push_back(axis);
  }
  return candidates;
}

CodedDetail DetailCoder::code(const Observations& seen, std::span<const glm::vec3> axes, double step) const {
  CodedDetail best;
  best.base = snapColour(meanColour(seen) - 0.5, step);
  best.error = measureFit(seen, LobeBasis(seen, {}), {}, best.base + 0.5, {});
  double least = best.error.squared;
  const double price = codebook_.isEmpty() ? price_ : price_ * (1 + kResidualPrice);
  const bool hasResiduals = codebook_.isEmpty() || options_.lobeAxisStep > 0;
  if (!codebook_.isEmpty()) tryLobes(seen, axes, AxisChoice::kEntries, price_, step, best, least);
  if (hasResiduals) tryLobes(seen, axes, AxisChoice::kResiduals, price, step, best, least);
  return best;
}

void DetailCoder::refit(const Observations& seen, double step, CodedDetail& detail) const {
  CodedDetail better = detail;
  const LobeBasis basis(seen, detail.axes);
  std::vector<uint32_t> all(detail.axes.size());
  std::iota(all.begin(), all.end(), 0u);
  better.base = snapColour(meanColour(seen) - 0.5, step);
  better.colours = fitColours(seen, basis, all, better.base + 0.5, step);
  better.error = measureFit(seen, basis, all, better.base + 0.5, better.colours);
  detail.error = measureFit(seen, basis, all, detail.base + 0.5, detail.colours);
  if (better.error.squared < detail.error.squared) detail = std::move(better);
}

void DetailCoder::tryLobes(const Observations& seen, std::span<const glm::vec3> axes, AxisChoice choice, double price,
                           double step, CodedDetail& best, double& least) const {
  if (least <= price) return;
  const LobeBasis basis(seen, candidates(axes, choice));
  const glm::dvec3 base = best.base + 0.5;
  LobeSelection selection(seen, basis, base);
  for (uint32_t count = 1; count <= options_.lobeLimit && count * price < least && selection.grow(); ++count) {
    if (selection.leastError() + count * price >= least) continue;
    std::vector<uint32_t> chosen = selection.chosen();
    std::sort(chosen.begin(), chosen.end());
    auto colours = fitColours(seen, basis, chosen, base, step);
    FitError error = measureFit(seen, basis, chosen, base, colours);
    if (error.squared + count * price >= least) continue;
    least = error.squared + count * price;
    best.error = std::move(error);
    best.colours = std::move(colours);
    best.axes.clear();
    for (uint32_t a : chosen) best.axes.push_back(basis.axes()[a]);
  }
}

}  // namespace froth
