#include "trainer/cuda/cuda_executor.h"

#include <algorithm>
#include <utility>

#include "trainer/cpu/view_exchange.h"
#include "trainer/loop/drift_tables.h"

namespace froth {

uint32_t cudaDeviceCount() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess ? static_cast<uint32_t>(count) : 0;
}

Result<std::unique_ptr<StepExecutor>> CudaExecutor::make(const FoamStorage<float>& foam, std::vector<Photo> photos,
                                                         bool isDeterministic) {
  auto made = makeOnOne(foam, std::make_shared<const std::vector<Photo>>(std::move(photos)), isDeterministic);
  if (!made) return made.error();
  return std::unique_ptr<StepExecutor>(std::move(*made));
}

Result<std::unique_ptr<CudaExecutor>> CudaExecutor::makeOnOne(const FoamStorage<float>& foam,
                                                              std::shared_ptr<const std::vector<Photo>> photos,
                                                              bool isDeterministic) {
  std::unique_ptr<CudaExecutor> executor(new CudaExecutor(std::move(photos)));
  if (Status started = executor->step_.start(isDeterministic); !started) return started.error();
  if (Status sent = executor->step_.upload(foam); !sent) return sent.error();
  return executor;
}

// A step changes the last entries of the tables alone; where they grow, all are sent.
Result<AdamStep<float>> CudaExecutor::sendDrifts(const AdamStep<float>& adam) {
  AdamStep<float> onDevice = adam;
  const uint32_t count = adam.step;  // entries 0 to step - 1
  const bool fits = count <= drifts_[0].size();
  const uint32_t first = fits ? driftsSent_ - std::min(driftsSent_, kLongestDrift) : 0;
  for (size_t i = 0; i < kParameterCount; ++i) {
    if (!fits) {
      if (Status grown = drifts_[i].resize(std::max<size_t>(2 * size_t{count}, 4096), "drifts"); !grown) {
        return grown.error();
      }
    }
    const Status sent =
        checkCuda(cudaMemcpyAsync(drifts_[i].data() + first, adam.drifts[i] + first, (count - first) * sizeof(float),
                                  cudaMemcpyHostToDevice, step_.stream()),
                  "upload of drifts");
    if (!sent) return sent.error();
    onDevice.drifts[i] = drifts_[i].data();
  }
  driftsSent_ = count;
  return onDevice;
}

Status CudaExecutor::beginStep(const StepPlan& plan) {
  const Result<AdamStep<float>> adam = sendDrifts(plan.adam);
  if (!adam) return adam.error();
  adam_ = *adam;
  leastSkin_ = plan.leastSkin;
  return {};
}

// Up to what the photo asks of the cells.
Status CudaExecutor::differentiate(uint32_t photo, const StepPlan& plan) {
  const Result<CudaPhotos::Target> target = photos_.at(photo, plan.halvings, step_.stream());
  if (!target) return target.error();
  const TrainingView<float>& view = target->view;
  const float perPixel = 1.0f / (static_cast<float>(view.width) * static_cast<float>(view.height));
  PixelSettings<float> settings;
  settings.perPixel = perPixel;
  settings.normalWeight = static_cast<float>(plan.weights.normal) * perPixel;
  const LossTerms terms{perPixel, -static_cast<float>(plan.weights.similarity) * perPixel / 3,
                        static_cast<float>(plan.weights.sparsity) * perPixel};
  if (Status ran = step_.activate(plan.leastSkin); !ran) return ran;
  if (Status ran = step_.render(view, settings, adam_); !ran) return ran;
  if (Status ran = step_.differentiateImage(target->image, terms); !ran) return ran;
  return step_.differentiate();
}

Status CudaExecutor::keepPhotos(const StepPlan& plan, uint32_t first, uint32_t count) {
  const auto photoCount = static_cast<uint32_t>(plan.photos.size());
  const auto overlapWeight = static_cast<float>(plan.weights.overlap);
  for (uint32_t i = first; i < first + count;) {
    if (Status ran = differentiate(plan.photos[i], plan); !ran) return ran;
    if (Status kept = step_.keepGradients(i, photoCount, adam_, overlapWeight); !kept) return kept;
    if (i + 1 == first + count) return {};
    const Result<bool> fits = step_.settle();
    if (!fits) return fits.error();
    i += *fits ? 1 : 0;
  }
  return {};
}

Status CudaExecutor::updateByPhotos(const StepPlan& plan, bool countsBad) {
  std::vector<glm::vec3> eyes;
  for (const uint32_t photo : plan.photos) {
    const Result<CudaPhotos::Target> target = photos_.at(photo, plan.halvings, step_.stream());
    if (!target) return target.error();
    eyes.push_back(target->view.eye);
  }
  return step_.updateByViews(eyes, adam_, countsBad);
}

Status CudaExecutor::runOnce(const StepPlan& plan) {
  if (plan.photos.size() > 1) {
    if (Status kept = keepPhotos(plan, 0, static_cast<uint32_t>(plan.photos.size())); !kept) return kept;
    return updateByPhotos(plan, true);
  }
  if (Status ran = differentiate(plan.photos[0], plan); !ran) return ran;
  return step_.update(adam_, static_cast<float>(plan.weights.overlap));
}

Status CudaExecutor::run(const StepPlan& plan) {
  if (Status begun = beginStep(plan); !begun) return begun;
  while (true) {
    if (Status ran = runOnce(plan); !ran) return ran;
    const Result<bool> isDone = step_.settle();
    if (!isDone) return isDone.error();
    if (*isDone) return {};
  }
}

Status CudaExecutor::show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) {
  const Result<AdamStep<float>> onDevice = sendDrifts(adam);
  if (!onDevice) return onDevice.error();
  const std::vector<float> directions = lensDirections(view);
  DeviceArray<float> sent;
  if (Status uploaded = sent.upload(directions, "directions of a lens", step_.stream()); !uploaded) return uploaded;
  TrainingView<float> seen = trainingView<float>(view);
  if (!directions.empty()) seen.directions = sent.data();
  while (true) {
    if (Status ran = step_.activate(leastSkin_); !ran) return ran;
    if (Status ran = step_.render(seen, {}, *onDevice); !ran) return ran;
    const Result<bool> isDone = step_.settle();
    if (!isDone) return isDone.error();
    if (*isDone) return step_.downloadImage(image);
  }
}

Status CudaExecutor::rearrange(const CellPlan& plan) { return step_.rearrange(plan); }

Result<CellFacts> CudaExecutor::facts() {
  if (Status read = step_.downloadFacts(facts_, overlaps_); !read) return read.error();
  return factsOf(facts_, overlaps_);
}

Status CudaExecutor::beginAnew() {
  step_.forgetPairs();
  return {};
}

Status CudaExecutor::read(FoamStorage<float>& foam) { return step_.download(foam); }

Result<uint64_t> CudaExecutor::droppedCount() {
  if (Result<bool> settled = step_.settle(); !settled) return settled.error();
  return uint64_t{step_.counters().droppedCount};
}

}  // namespace froth
