// Steps on a GPU. Sums are atomic there, so two runs from the same seed differ by rounding, and soon by more; those of
// a deterministic executor do not, on GPUs of one architecture.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "trainer/cuda/cuda_photos.h"
#include "trainer/cuda/cuda_step.h"
#include "trainer/loop/step_executor.h"

namespace froth {

// GPUs of this machine with a driver that can run steps.
uint32_t cudaDeviceCount();
inline bool hasCudaDevice() { return cudaDeviceCount() > 0; }

class CudaExecutor : public StepExecutor {
 public:
  // `photos` are those that train, with views in the normalised scene. Fails with kDevice where there is no GPU.
  static Result<std::unique_ptr<StepExecutor>> make(const FoamStorage<float>& foam, std::vector<Photo> photos,
                                                    bool isDeterministic = false);
  // On the GPU that is the calling thread's; it must be at all later calls too.
  static Result<std::unique_ptr<CudaExecutor>> makeOnOne(const FoamStorage<float>& foam,
                                                         std::shared_ptr<const std::vector<Photo>> photos,
                                                         bool isDeterministic);

  Status run(const StepPlan& plan) override;
  Status rearrange(const CellPlan& plan) override;
  Status average() override { return step_.average(); }
  Status takeMeans() override { return step_.takeMeans(); }
  Result<CellFacts> facts() override;
  uint32_t cellCount() const override { return step_.cellCount(); }
  Status show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) override;
  Status read(FoamStorage<float>& foam) override;
  Status beginAnew() override;
  Result<uint64_t> droppedCount() override;

  // run() of several photos in parts, for who spreads them over GPUs, in this order.
  Status beginStep(const StepPlan& plan);
  // Keeps what the photos [first, first + count) of the plan ask; settled are all but the last.
  Status keepPhotos(const StepPlan& plan, uint32_t first, uint32_t count);
  // When what all photos of the plan ask is kept. countsBad: CudaStep::updateByViews().
  Status updateByPhotos(const StepPlan& plan, bool countsBad);

  CudaStep& step() { return step_; }
  size_t byteCount() const { return step_.byteCount() + photos_.byteCount(); }  // of GPU memory

 private:
  explicit CudaExecutor(std::shared_ptr<const std::vector<Photo>> photos) : photos_(std::move(photos)) {}
  Status runOnce(const StepPlan& plan);
  Status differentiate(uint32_t photo, const StepPlan& plan);
  Result<AdamStep<float>> sendDrifts(const AdamStep<float>& adam);

  CudaStep step_;
  CudaPhotos photos_;
  std::array<DeviceArray<float>, kParameterCount> drifts_;
  uint32_t driftsSent_ = 0;   // steps whose drifts the GPU has
  AdamStep<float> adam_;      // of the step, with pointers to device memory
  float leastSkin_ = 0;       // of the last step
  FoamStorage<float> facts_;  // what facts() looks into
  std::vector<uint32_t> overlaps_;
};

}  // namespace froth
