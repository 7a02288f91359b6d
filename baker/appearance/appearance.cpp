#include "baker/appearance/appearance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "baker/appearance/axis_codebook.h"
#include "baker/appearance/cell_coder.h"
#include "baker/appearance/lobe_selection.h"
#include "baker/appearance/observations.h"
#include "baker/appearance/view_balance.h"

namespace froth {
namespace {

constexpr uint32_t kDetailsPerEntry = 4;  // of the sample that trains the codebook

std::span<const glm::vec3> axesOf(const Foam& foam, uint64_t detail) {
  const LobeRange lobes = lobesOf(foam, detail);
  return std::span(foam.lobeAxes).subspan(lobes.first, lobes.count);
}

// The axes that detail site `detail` would keep if they could be stored exactly.
std::vector<glm::vec3> sampleAxes(const Foam& foam, const Observer& observer, const AppearanceOptions& options,
                                  uint64_t detail) {
  const Observations seen = observer.observe(detail);
  const auto axes = axesOf(foam, detail);
  const LobeBasis basis(seen, {axes.begin(), axes.end()});
  const glm::dvec3 base = meanColour(seen);
  const double bound = double(options.errorBound) * options.errorBound;
  if (measureFit(seen, basis, {}, base, {}).squared <= bound) return {};
  LobeSelection selection(seen, basis, base);
  while (selection.chosen().size() < options.lobeLimit && selection.grow() && selection.leastError() > bound) {
  }
  std::vector<glm::vec3> kept;
  for (uint32_t a : selection.chosen()) kept.push_back(axes[a]);
  return kept;
}

std::vector<glm::vec3> sampleAxes(const Foam& foam, const Observer& observer, const AppearanceOptions& options,
                                  const Progress& progress) {
  constexpr uint64_t kSlice = 512;  // detail sites between looks at the progress
  const uint64_t allDetails = uint64_t{foam.cellCount} * foam.detailCount;
  const uint64_t count = std::min<uint64_t>(allDetails, uint64_t{kDetailsPerEntry} * options.codebookSize);
  std::vector<std::vector<glm::vec3>> perDetail(count);
  for (uint64_t first = 0; first < count; first += kSlice) {
    if (!report(progress, "lobes sampled", first, count)) return {};
    tbb::parallel_for(first, std::min(first + kSlice, count),
                      [&](uint64_t i) { perDetail[i] = sampleAxes(foam, observer, options, i * allDetails / count); });
  }
  std::vector<glm::vec3> samples;
  for (const auto& some : perDetail) samples.insert(samples.end(), some.begin(), some.end());
  return samples;
}

}  // namespace

struct AppearanceCoder::Model {
  Observer observer;
  AxisCodebook codebook;
};

Result<AppearanceCoder> AppearanceCoder::create(const Foam& foam, const Visibility* visibility,
                                                const AppearanceOptions& options, const Progress& progress) {
  AppearanceCoder coder;
  coder.foam_ = &foam;
  coder.options_ = options;
  AxisCodebook codebook;
  if (options.codebookSize > 0) {
    const auto samples = sampleAxes(foam, Observer(foam, visibility, options.eyeRadius), options, progress);
    codebook = AxisCodebook(trainCodebook(samples, options.codebookSize, options.seed, progress));
  }
  std::vector<float> viewWeights;
  if (visibility) viewWeights = balanceViews(foam, *visibility, codebook, options, progress);
  if (!report(progress, "codebook", 1, 1)) return stoppedOnRequest("codebook");
  Observer observer(foam, visibility, options.eyeRadius, std::move(viewWeights));
  coder.model_ = std::make_shared<const Model>(Model{std::move(observer), std::move(codebook)});
  return coder;
}

AppearanceCoder AppearanceCoder::forFoam(const Foam& foam, const Visibility* visibility, float weight) const {
  AppearanceCoder coder = *this;
  coder.foam_ = &foam;
  Observer observer(foam, visibility, -1, model_->observer.viewWeights(), weight);
  coder.model_ = std::make_shared<const Model>(Model{std::move(observer), model_->codebook});
  return coder;
}

const std::vector<glm::vec3>& AppearanceCoder::codebook() const { return model_->codebook.entries(); }

CellAppearance AppearanceCoder::compress(std::span<const uint32_t> cells) const {
  CellAppearance out;
  const CellCoder coder(*foam_, model_->observer, model_->codebook, options_);
  for (uint32_t cell : cells) coder.append(cell, out);
  return out;
}

}  // namespace froth
