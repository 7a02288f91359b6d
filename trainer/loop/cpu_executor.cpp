#include "trainer/loop/cpu_executor.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "trainer/cpu/view_exchange.h"
#include "trainer/photos/reduce_photo.h"
#include "trainer/step/crowds.h"
#include "trainer/step/running_mean.h"

namespace froth {
namespace {

// Over the mean of backgrounds, grey.
std::vector<glm::vec4> wantedOf(const Photo& photo) {
  std::vector<glm::vec4> wanted(photo.rgba.size() / 4);
  for (size_t i = 0; i < wanted.size(); ++i) {
    const uint8_t* rgba = &photo.rgba[4 * i];
    const float grey = 0.5f * (1 - static_cast<float>(rgba[3]) / 255);
    const bool counts = photo.counted.empty() || photo.counted[i];
    wanted[i] = glm::vec4(glm::vec3(rgba[0], rgba[1], rgba[2]) / 255.0f + grey, counts ? 1.0f : 0.0f);
  }
  return wanted;
}

}  // namespace

CpuExecutor::CpuExecutor(FoamStorage<float> foam, std::vector<Photo> photos)
    : foam_(std::move(foam)), photos_(std::move(photos)) {}

const CpuExecutor::PhotoTarget& CpuExecutor::targetOf(uint32_t photo, uint32_t halvings) {
  if (halvings_ != halvings) {
    halvings_ = halvings;
    targets_.assign(photos_.size(), {});
    tbb::parallel_for(size_t{0}, photos_.size(), [&](size_t i) {
      targets_[i].photo = reducePhoto(photos_[i], halvings_);
      targets_[i].directions = lensDirections(targets_[i].photo.view);
      targets_[i].wanted = wantedOf(targets_[i].photo);
    });
  }
  return targets_[photo];
}

void CpuExecutor::differentiate(uint32_t photo, const StepPlan& plan) {
  const PhotoTarget& target = targetOf(photo, plan.halvings);
  TrainingView<float> view = trainingView<float>(target.photo.view);
  if (!target.directions.empty()) view.directions = target.directions.data();
  const size_t pixelCount = target.wanted.size();
  PixelSettings<float> settings;
  settings.perPixel = 1.0f / static_cast<float>(pixelCount);
  settings.normalWeight = static_cast<float>(plan.weights.normal) * settings.perPixel;

  const std::vector<glm::vec4>& rendered = step_.render(view, settings, plan.adam);
  gradients_.resize(pixelCount);
  const uint8_t* counted = target.photo.counted.empty() ? nullptr : target.photo.counted.data();
  const LossTarget wanted{view.width, view.height, target.photo.rgba.data(), counted};
  loss_.evaluate(wanted, rendered, plan.weights.similarity, gradients_);
  // Sparsity: the mean of 1 - T_N.
  const float sparsity = static_cast<float>(plan.weights.sparsity) * settings.perPixel;
  for (size_t i = 0; i < pixelCount; ++i) gradients_[i].w -= sparsity * target.wanted[i].w;
  step_.differentiate(gradients_, target.wanted);
}

Status CpuExecutor::run(const StepPlan& plan) {
  shown_.reset();
  const auto overlapWeight = static_cast<float>(plan.weights.overlap);
  step_.activate(plan.leastSkin);
  if (plan.photos.size() == 1) {
    differentiate(plan.photos[0], plan);
    step_.update(plan.adam, overlapWeight);
    return {};
  }
  for (const uint32_t photo : plan.photos) {
    differentiate(photo, plan);
    step_.keepGradients(plan.adam, overlapWeight);
  }
  step_.updateByViews(plan.adam);
  return {};
}

Status CpuExecutor::rearrange(const CellPlan& plan) {
  shown_.reset();
  foam_ = froth::rearrange(foam_, plan);
  step_.forgetPairs();
  return {};
}

Status CpuExecutor::average() {
  const uint32_t count = ++foam_.averagedSteps;
  for (size_t t = 0; t < kParameterCount; ++t) {
    const std::vector<float>& values = foam_.values[t];
    std::vector<float>& means = foam_.meanValues[t];
    means.resize(values.size());
    tbb::parallel_for(size_t{0}, values.size(), [&](size_t i) { means[i] = foldIntoMean(means[i], values[i], count); });
  }
  return {};
}

Status CpuExecutor::takeMeans() {
  if (foam_.averagedSteps == 0) return {};
  shown_.reset();
  foam_.values = std::exchange(foam_.meanValues, {});
  foam_.averagedSteps = 0;
  for (std::vector<float>& moments : foam_.firstMoments) std::fill(moments.begin(), moments.end(), 0.0f);
  step_.forgetPairs();
  return {};
}

Status CpuExecutor::show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) {
  if (!shown_) {
    shown_ = std::make_unique<CpuStep<float>>(foam_);
    shown_->activate(0);
  }
  const std::vector<float> directions = lensDirections(view);
  TrainingView<float> seen = trainingView<float>(view);
  if (!directions.empty()) seen.directions = directions.data();
  image = shown_->render(seen, PixelSettings<float>{}, adam);
  return {};
}

Result<CellFacts> CpuExecutor::facts() {
  overlaps_.resize(foam_.shape.cellCount);
  tbb::parallel_for(0u, foam_.shape.cellCount,
                    [&](uint32_t cell) { overlaps_[cell] = countOverlaps(foam_.balls.data(), step_.rows(), cell); });
  return factsOf(foam_, overlaps_);
}

Status CpuExecutor::read(FoamStorage<float>& foam) {
  foam = foam_;
  return {};
}

Status CpuExecutor::beginAnew() {
  step_.forgetPairs();
  return {};
}

}  // namespace froth
