#include "baker/appearance/appearance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "baker/appearance/axis_codebook.h"
#include "baker/appearance/lobe_selection.h"
#include "baker/appearance/observations.h"
#include "baker/appearance/site_coder.h"
#include "format/quantization.h"

namespace froth {
namespace {

constexpr uint32_t kLargestScale = 15;
constexpr double kCoarsestStep = 0.25;      // [display-coded]
constexpr double kRoundingShare = 0.25;     // of the allowed squared error, for the rounding of colours
constexpr uint32_t kSitesPerEntry = 16;     // of the sample that trains the codebook

std::span<const glm::vec3> axesOf(const Foam& foam, uint64_t site) {
  const LobeRange lobes = lobesOf(foam, site);
  return std::span(foam.lobeAxes).subspan(lobes.first, lobes.count);
}

double weightOf(const Observations& seen) {
  double sum = 0;
  for (float weight : seen.weights) sum += weight;
  return sum;
}

// The coarsest lattice on which rounding alone stays well inside the bound: uniform errors of +- half a step.
uint8_t chooseScale(const AppearanceOptions& options, double weight) {
  if (!(options.colourStep > 0)) return 0;
  const double step = std::min(options.errorBound * std::sqrt(12 * kRoundingShare / weight), kCoarsestStep);
  const double scale = std::floor(std::log2(std::max(step / options.colourStep, 1.0)));
  return static_cast<uint8_t>(std::min<double>(scale, kLargestScale));
}

glm::vec3 snapCellColour(const glm::dvec3& colour) {
  return glm::vec3(glm::roundEven(glm::clamp(colour, 0.0, 1.0) * 255.0) / 255.0);
}

// The lobes that detail site `site` would keep if axes were exact, weighed by the errors that a wrong axis makes.
void sampleLobes(const Foam& foam, const Observer& observer, const AppearanceOptions& options, uint64_t site,
                 std::vector<WeightedAxis>& samples) {
  const Observations seen = observer.observe(site);
  const auto axes = axesOf(foam, site);
  const LobeBasis basis(seen, {axes.begin(), axes.end()});
  const glm::dvec3 base = meanColour(seen);
  const double bound = double(options.errorBound) * options.errorBound;
  if (measureFit(seen, basis, {}, base, {}).squared <= bound) return;
  LobeSelection selection(seen, basis, base);
  while (selection.chosen().size() < options.lobeLimit && selection.grow() && selection.leastError() > bound) {
  }
  const auto& chosen = selection.chosen();
  const auto colours = LobeEquations(seen, basis, chosen, base).solve();
  std::vector<double> shares(chosen.size()), weights(chosen.size());
  for (size_t i = 0; i < seen.size(); ++i) {
    basis.sharesAlong(i, chosen, shares.data());
    for (size_t l = 0; l < chosen.size(); ++l) weights[l] += seen.weights[i] * shares[l] * (1 - shares[l]);
  }
  for (size_t l = 0; l < chosen.size(); ++l) {
    const double weight = weights[l] * std::min(1.0, glm::dot(colours[l], colours[l]));
    if (weight > 0) samples.push_back({basis.axes()[chosen[l]], static_cast<float>(weight)});
  }
}

std::vector<WeightedAxis> sampleAxes(const Foam& foam, const Observer& observer, const AppearanceOptions& options) {
  const uint64_t siteCount = uint64_t{foam.cellCount} * foam.detailCount;
  const uint64_t count = std::min<uint64_t>(siteCount, uint64_t{kSitesPerEntry} * options.codebookSize);
  std::vector<std::vector<WeightedAxis>> perSite(count);
  tbb::parallel_for(uint64_t{0}, count, [&](uint64_t i) {
    sampleLobes(foam, observer, options, i * siteCount / count, perSite[i]);
  });
  std::vector<WeightedAxis> samples;
  for (const auto& some : perSite) samples.insert(samples.end(), some.begin(), some.end());
  return samples;
}

// Appends the coded cell.
void compressCell(const Foam& foam, const Observer& observer, const AxisCodebook& codebook, const AppearanceOptions& options,
                  uint32_t cell, CellAppearance& out) {
  const uint32_t K = foam.detailCount;
  std::vector<Observations> seen;
  glm::dvec3 colourSum(0);
  double weightSum = 0, largestWeight = 0;
  for (uint32_t k = 0; k < K; ++k) {
    seen.push_back(observer.observe(uint64_t{cell} * K + k));
    const double weight = weightOf(seen.back());
    colourSum += weight * meanColour(seen.back());
    weightSum += weight;
    largestWeight = std::max(largestWeight, weight);
  }
  out.cellColours.push_back(snapCellColour(colourSum / weightSum));
  const uint8_t scale = chooseScale(options, largestWeight);
  out.colourScales.push_back(scale);
  const double step = std::ldexp(double(options.colourStep), scale);
  const SiteCoder coder(options, codebook, double(options.errorBound) * options.errorBound);
  for (uint32_t k = 0; k < K; ++k) {
    const CodedSite site = coder.code(seen[k], axesOf(foam, uint64_t{cell} * K + k), step);
    out.baseColours.push_back(glm::vec3(site.base));
    out.lobeCounts.push_back(static_cast<uint8_t>(site.axes.size()));
    out.lobeAxes.insert(out.lobeAxes.end(), site.axes.begin(), site.axes.end());
    for (const glm::dvec3& colour : site.colours) out.lobeColours.push_back(glm::vec3(colour));
    out.squaredError += site.error.squared;
    out.maxError = std::max(out.maxError, site.error.largest);
  }
  out.weight += weightSum;
}

}  // namespace

struct AppearanceCoder::Model {
  Observer observer;
  AxisCodebook codebook;
};

Result<AppearanceCoder> AppearanceCoder::create(const Foam& foam, const Visibility* visibility,
                                                const AppearanceOptions& options, const Progress& progress) {
  if (!report(progress, "codebook", 0, 1)) return makeError(ErrorKind::kCancelled, "codebook: stopped on request");
  AppearanceCoder coder;
  coder.foam_ = &foam;
  coder.options_ = options;
  auto model = std::make_shared<Model>(Model{Observer(foam, visibility), {}});
  if (options.codebookSize > 0) {
    const auto samples = sampleAxes(foam, model->observer, options);
    model->codebook = AxisCodebook(trainCodebook(samples, options.codebookSize, options.seed));
  }
  coder.model_ = std::move(model);
  return coder;
}

const std::vector<glm::vec3>& AppearanceCoder::codebook() const {
  return model_->codebook.entries();
}

CellAppearance AppearanceCoder::compress(std::span<const uint32_t> cells) const {
  CellAppearance out;
  for (uint32_t cell : cells) compressCell(*foam_, model_->observer, model_->codebook, options_, cell, out);
  return out;
}

}  // namespace froth
