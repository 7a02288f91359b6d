#include "trainer/cuda/cuda_executor.h"

#include <algorithm>
#include <utility>

#include "trainer/cpu/view_exchange.h"
#include "trainer/loop/drift_tables.h"

namespace froth {

bool hasCudaDevice() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
}

Result<std::unique_ptr<StepExecutor>> CudaExecutor::make(FoamStorage<float> foam, std::vector<Photo> photos) {
  std::unique_ptr<CudaExecutor> executor(new CudaExecutor(std::move(photos)));
  if (Status started = executor->step_.start(); !started) return started.error();
  if (Status sent = executor->step_.upload(foam); !sent) return sent.error();
  return std::unique_ptr<StepExecutor>(std::move(executor));
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

Status CudaExecutor::runOnce(const StepPlan& plan, const CudaPhotos::Target& target, const AdamStep<float>& adam) {
  const float perPixel = 1.0f / (static_cast<float>(target.view.width) * static_cast<float>(target.view.height));
  PixelSettings<float> settings;
  settings.perPixel = perPixel;
  settings.normalWeight = static_cast<float>(plan.weights.normal) * perPixel;
  const LossTerms terms{perPixel, -static_cast<float>(plan.weights.similarity) * perPixel / 3,
                        static_cast<float>(plan.weights.sparsity) * perPixel};
  if (Status ran = step_.activate(plan.leastSkin); !ran) return ran;
  if (Status ran = step_.render(target.view, settings, adam); !ran) return ran;
  if (Status ran = step_.differentiateImage(target.image, terms); !ran) return ran;
  if (Status ran = step_.differentiate(); !ran) return ran;
  return step_.update(adam, static_cast<float>(plan.weights.overlap));
}

Status CudaExecutor::run(const StepPlan& plan) {
  const Result<CudaPhotos::Target> target = photos_.at(plan.photo, plan.halvings, step_.stream());
  if (!target) return target.error();
  const Result<AdamStep<float>> adam = sendDrifts(plan.adam);
  if (!adam) return adam.error();
  leastSkin_ = plan.leastSkin;
  while (true) {
    if (Status ran = runOnce(plan, *target, *adam); !ran) return ran;
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

Status CudaExecutor::read(FoamStorage<float>& foam) { return step_.download(foam); }

Result<uint64_t> CudaExecutor::droppedCount() {
  if (Result<bool> settled = step_.settle(); !settled) return settled.error();
  return uint64_t{step_.counters().droppedCount};
}

}  // namespace froth
