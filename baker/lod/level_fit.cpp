#include "baker/lod/level_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "baker/lod/detail_sharpness.h"
#include "baker/lod/fit_views.h"
#include "baker/lod/free_cells.h"
#include "baker/lod/shrink_view.h"
#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"

namespace froth {
namespace {

constexpr uint32_t kBoxSide = 2;      // [rays]
constexpr double kMostBoxes = 8'000;  // of a view: from some cells on a fit costs the same
constexpr double kBoxesPerCell = 1;   // ... and less in small foams
constexpr double kLastRate = 0.05;    // of the first
constexpr float kRayCutoff = 1e-2f;   // of a ray's transmittance

PixelSettings<float> raySettings() {
  PixelSettings<float> settings;
  settings.sharpness = static_cast<float>(kTrainedSharpness);
  settings.perPixel = 1;
  settings.cutoff = kRayCutoff;
  return settings;
}

// No parameter waits for a step of Adam: FreeCells makes them.
constexpr AdamStep<float> kNoAdam{};

// A view as a step takes it. The directions of a lens are many, so they are made for each step anew.
struct StepView {
  explicit StepView(const View& view) : directions(lensDirections(view)), training(trainingView<float>(view)) {
    if (!directions.empty()) training.directions = directions.data();
  }

  const std::vector<float> directions;
  TrainingView<float> training;
};

size_t boxOf(size_t ray, uint32_t width) {
  return ray / width / kBoxSide * (width / kBoxSide) + ray % width / kBoxSide;
}

std::vector<glm::vec4> meansOfBoxes(const std::vector<glm::vec4>& rays, uint32_t width) {
  std::vector<glm::vec4> boxes(rays.size() / (kBoxSide * kBoxSide), glm::vec4(0));
  for (size_t ray = 0; ray < rays.size(); ++ray) {
    boxes[boxOf(ray, width)] += rays[ray] / float{kBoxSide * kBoxSide};
  }
  return boxes;
}

// Of half the squared difference of boxes, times the rays of a box.
std::vector<glm::vec4> gradientsOf(const std::vector<glm::vec4>& rays, const std::vector<glm::vec4>& wanted,
                                   uint32_t width) {
  const std::vector<glm::vec4> boxes = meansOfBoxes(rays, width);
  std::vector<glm::vec4> gradients(rays.size());
  for (size_t ray = 0; ray < rays.size(); ++ray) {
    gradients[ray] = boxes[boxOf(ray, width)] - wanted[boxOf(ray, width)];
  }
  return gradients;
}

// Views that follow each other stand apart.
size_t strideThrough(size_t count) {
  size_t stride = static_cast<size_t>(static_cast<double>(count) / std::numbers::phi) + 1;
  while (std::gcd(stride, count) != 1) ++stride;
  return stride;
}

}  // namespace

LevelFit::LevelFit(std::span<const View> views, const FrontOptions& options)
    : given_(chooseFitViews(views)), options_(options) {}

Status LevelFit::takeFinest(const Foam& foam, const Progress& progress) {
  if (given_.empty() || foam.lobeCount == 0 || !foam.baseColours.empty() || !foam.lobeOffsets.empty()) return {};
  FoamStorage<float> storage = storeFoam<float>(foam, AdamMoments::kNone);
  CpuStep<float> step(storage);
  step.activate(0);
  views_.reserve(given_.size());
  for (const View& given : given_) {
    if (!report(progress, "level fit", views_.size(), given_.size())) return stoppedOnRequest("level fit");
    View view = shrinkView(given, std::min(kMostBoxes, kBoxesPerCell * foam.cellCount));
    view = resizeView(view, kBoxSide * view.width, kBoxSide * view.height);
    view.nearRatio = view.nearRatio.value_or(options_.nearRatio);
    view.nearDepth = view.nearDepth.value_or(options_.nearDepth);
    views_.push_back({view, meansOfBoxes(step.render(StepView(view).training, raySettings(), kNoAdam), view.width)});
  }
  return {};
}

Status LevelFit::fit(Foam& foam, std::span<const uint8_t> isFree, size_t viewCount, const Progress& progress) const {
  FoamStorage<float> storage = storeFoam<float>(foam, AdamMoments::kNone);
  CpuStep<float> step(storage);
  step.activate(0);
  FreeCells cells(storage, isFree);
  const size_t count = std::min(viewCount, views_.size()), stride = strideThrough(views_.size());
  for (size_t s = 0; s < count; ++s) {
    if (!report(progress, "level fit", s, count)) return stoppedOnRequest("level fit");
    const FitView& fit = views_[s * stride % views_.size()];
    const StepView view(fit.view);
    const std::vector<glm::vec4>& shown = step.render(view.training, raySettings(), kNoAdam);
    const std::vector<glm::vec4> gradients = gradientsOf(shown, fit.wanted, fit.view.width);
    step.differentiate(gradients, gradients);
    const double half = 0.5 * (1 + std::cos(std::numbers::pi * static_cast<double>(s) / static_cast<double>(count)));
    cells.update(step, static_cast<float>(kLastRate + (1 - kLastRate) * half));
  }
  cells.write(foam);
  return {};
}

void copyFittedFace(const Foam& from, uint32_t fromCell, Foam& to, uint32_t toCell) {
  const auto copy = [&](auto values, size_t perCell) {
    std::copy_n((from.*values).begin() + static_cast<std::ptrdiff_t>(fromCell * perCell), perCell,
                (to.*values).begin() + static_cast<std::ptrdiff_t>(toCell * perCell));
  };
  copy(&Foam::orientations, 1);
  copy(&Foam::detailSites, from.detailCount);
  copy(&Foam::detailHeights, from.detailCount);
  copy(&Foam::lobeColours, size_t{from.detailCount} * from.lobeCount);
}

}  // namespace froth
