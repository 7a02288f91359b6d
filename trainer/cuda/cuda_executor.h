// Steps on a GPU. Sums are atomic there, so two runs from the same seed differ by rounding, and soon by more.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "trainer/cuda/cuda_photos.h"
#include "trainer/cuda/cuda_step.h"
#include "trainer/loop/step_executor.h"

namespace froth {

// Whether this machine has a GPU and a driver that can run steps.
bool hasCudaDevice();

class CudaExecutor : public StepExecutor {
 public:
  // `photos` are those that train, with views in the normalised scene. Fails with kDevice where there is no GPU.
  static Result<std::unique_ptr<StepExecutor>> make(FoamStorage<float> foam, std::vector<Photo> photos);

  Status run(const StepPlan& plan) override;
  Status rearrange(const CellPlan& plan) override;
  Result<CellFacts> facts() override;
  uint32_t cellCount() const override { return step_.cellCount(); }
  Status show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) override;
  Status read(FoamStorage<float>& foam) override;
  Status beginAnew() override { return {}; }
  Result<uint64_t> droppedCount() override;

  CudaStep& step() { return step_; }
  size_t byteCount() const { return step_.byteCount() + photos_.byteCount(); }  // of GPU memory

 private:
  explicit CudaExecutor(std::vector<Photo> photos) : photos_(std::move(photos)) {}
  Status runOnce(const StepPlan& plan, const CudaPhotos::Target& target, const AdamStep<float>& adam);
  Result<AdamStep<float>> sendDrifts(const AdamStep<float>& adam);

  CudaStep step_;
  CudaPhotos photos_;
  std::array<DeviceArray<float>, kParameterCount> drifts_;
  uint32_t driftsSent_ = 0;   // steps whose drifts the GPU has
  float leastSkin_ = 0;       // of the last step
  FoamStorage<float> facts_;  // what facts() looks into
  std::vector<uint32_t> overlaps_;
};

}  // namespace froth
