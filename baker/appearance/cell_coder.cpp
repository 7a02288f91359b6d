#include "baker/appearance/cell_coder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace froth {
namespace {

constexpr uint32_t kLargestScale = 15;
constexpr double kCoarsestStep = 0.25;  // [display-coded] of colours
constexpr double kRoundingShare =
    0.75;                             // squared error of rounding a detail site's colours, relative to a lobe's price
constexpr int kRefits = 2;            // of all colours, once every detail site knows what the others get wrong
constexpr float kMostCarried = 0.3f;  // [display-coded] error of others that a detail site makes up for

// A detail site that lies wrong by x radii shows, as images blend them, as a colour wrong by kShiftGain x
// times how much it differs from its cell's mean.
constexpr double kShiftGain = 4;
constexpr double kLeastDifference = 0.03;       // [display-coded] cells border on others too
constexpr double kShiftShare = 0.2;             // squared error of a cell's detail sites, relative to a lobe's price
constexpr double kCoarsestDetailStep = 0x1p-5;  // [radii]

glm::vec3 snapCellColour(const glm::dvec3& colour) {
  return glm::vec3(glm::roundEven(glm::clamp(colour, 0.0, 1.0) * 255.0) / 255.0);
}

// What an error of `other` looks like where `seen` shows: both are seen from an eye with the same overlap as
// from all.
void addCarried(const Observations& seen, const Observations& other, std::span<const glm::vec3> misses, float overlap,
                std::span<glm::vec3> carried) {
  for (size_t i = 0, j = 0; i < seen.size(); ++i) {
    while (j < other.size() && other.eyes[j] < seen.eyes[i]) ++j;
    if (j == other.size()) return;
    if (other.eyes[j] != seen.eyes[i]) continue;
    carried[i] += overlap * std::sqrt(other.weights[j] / seen.weights[i]) * misses[j];
  }
}

}  // namespace

std::vector<CellCoder::Detail> CellCoder::observeCell(uint32_t cell) const {
  std::vector<Detail> details(foam_.detailCount);
  for (uint32_t k = 0; k < foam_.detailCount; ++k) {
    details[k].seen = observer_.observe(uint64_t{cell} * foam_.detailCount + k);
    details[k].weight = totalWeight(details[k].seen);
  }
  return details;
}

// The coarsest lattice on which rounding (uniform errors of +- half a step) stays small even where the cell
// shows most.
uint8_t CellCoder::chooseColourScale(const std::vector<Detail>& details) const {
  if (!(options_.colourStep > 0)) return 0;
  double weight = 0;
  for (const Detail& detail : details) weight = std::max(weight, detail.weight);
  const double step = std::min(std::sqrt(12 * kRoundingShare * lobePrice() / weight), kCoarsestStep);
  const double scale = std::floor(std::log2(std::max(step / options_.colourStep, 1.0)));
  return static_cast<uint8_t>(std::min<double>(scale, kLargestScale));
}

glm::dvec3 CellCoder::meanOf(const std::vector<Detail>& details) {
  glm::dvec3 colours(0);
  double weights = 0;
  for (const Detail& detail : details) {
    colours += detail.weight * meanColour(detail.seen);
    weights += detail.weight;
  }
  return colours / weights;
}

double CellCoder::shiftError(const Detail& detail, const glm::dvec3& cellMean) {
  const glm::dvec3 difference = meanColour(detail.seen) - cellMean;
  return kShiftGain * kShiftGain * (kLeastDifference * kLeastDifference + glm::dot(difference, difference) / 3);
}

uint8_t CellCoder::chooseDetailScale(const std::vector<Detail>& details) const {
  const glm::dvec3 mean = meanOf(details);
  double error = 0;
  for (const Detail& detail : details) error += detail.weight * shiftError(detail, mean);
  const double step = std::min(std::sqrt(kShiftShare * lobePrice() / error), kCoarsestDetailStep);
  return static_cast<uint8_t>(std::floor(std::log2(std::max(step / options_.detailSiteStep, 1.0))));
}

void CellCoder::codeDetails(uint32_t cell, double step, std::vector<Detail>& details) const {
  const DetailCoder coder(options_, codebook_, lobePrice());
  std::vector<uint32_t> order(details.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return details[a].weight < details[b].weight; });
  for (int round = 0; round <= kRefits; ++round) {
    for (size_t n = 0; n < order.size(); ++n) {
      const uint32_t k = order[n];
      Detail& detail = details[k];
      const auto others = std::span(order).first(round > 0 ? order.size() : n);
      const std::vector<glm::vec3> carried = carriedTo(cell, k, details, others);
      Observations wanted = detail.seen;
      for (size_t i = 0; i < wanted.size(); ++i) wanted.colours[i] -= carried[i];
      if (round == 0) {
        const LobeRange lobes = lobesOf(foam_, uint64_t{cell} * details.size() + k);
        detail.coded = coder.code(wanted, std::span(foam_.lobeAxes).subspan(lobes.first, lobes.count), step);
      } else {
        coder.refit(wanted, step, detail.coded);
      }
      detail.misses = detail.coded.error.misses;
      for (size_t i = 0; i < wanted.size(); ++i) detail.misses[i] -= carried[i];
    }
  }
}

std::vector<glm::vec3> CellCoder::carriedTo(uint32_t cell, uint32_t k, const std::vector<Detail>& details,
                                            std::span<const uint32_t> others) const {
  std::vector<glm::vec3> carried(details[k].seen.size(), glm::vec3(0));
  for (uint32_t l : others) {
    if (l != k) addCarried(details[k].seen, details[l].seen, details[l].misses, observer_.overlap(cell, k, l), carried);
  }
  for (glm::vec3& c : carried) c = glm::clamp(c, -kMostCarried, kMostCarried);
  return carried;
}

void CellCoder::addViewErrors(uint32_t cell, std::span<double> perView) const {
  std::vector<Detail> details = observeCell(cell);
  codeDetails(cell, std::ldexp(double(options_.colourStep), chooseColourScale(details)), details);
  const glm::dvec3 mean = meanOf(details);
  const double step = options_.detailSiteStep > 0 ? std::ldexp(options_.detailSiteStep, chooseDetailScale(details)) : 0;
  for (const Detail& detail : details) {
    const double shifted = step * step * shiftError(detail, mean);
    for (size_t i = 0; i < detail.seen.size(); ++i) {
      const std::optional<uint32_t> view = observer_.viewOfEye(detail.seen.eyes[i]);
      if (!view) continue;
      // Times what the cell's other errors look like there too.
      const double squared = glm::dot(glm::dvec3(detail.misses[i]), glm::dvec3(detail.coded.error.misses[i])) / 3;
      perView[*view] += detail.seen.weights[i] / observer_.viewWeight(*view) * (squared + shifted);
    }
  }
}

void CellCoder::append(uint32_t cell, CellAppearance& out) const {
  std::vector<Detail> details = observeCell(cell);
  const uint8_t scale = chooseColourScale(details);
  codeDetails(cell, std::ldexp(double(options_.colourStep), scale), details);
  double weightSum = 0;
  for (const Detail& detail : details) {
    weightSum += detail.weight;
    out.baseColours.push_back(glm::vec3(detail.coded.base));
    out.lobeCounts.push_back(static_cast<uint8_t>(detail.coded.axes.size()));
    out.lobeAxes.insert(out.lobeAxes.end(), detail.coded.axes.begin(), detail.coded.axes.end());
    for (const glm::dvec3& colour : detail.coded.colours) out.lobeColours.push_back(glm::vec3(colour));
    for (size_t i = 0; i < detail.seen.size(); ++i) {
      const glm::dvec3 miss = detail.misses[i];
      out.squaredError += detail.seen.weights[i] * glm::dot(miss, miss) / 3;
      for (int c = 0; c < 3; ++c) out.maxError = std::max(out.maxError, std::abs(miss[c]));
    }
  }
  if (options_.detailSiteStep > 0) out.detailScales.push_back(chooseDetailScale(details));
  out.cellColours.push_back(snapCellColour(meanOf(details)));
  out.colourScales.push_back(scale);
  out.weight += weightSum;
}

}  // namespace froth
