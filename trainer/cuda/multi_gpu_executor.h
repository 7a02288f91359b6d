// Steps of several photos, spread over GPUs of this machine. All GPUs hold the same foam, photos and moments. In a step
// each takes its share of the photos, up to what they ask of the cells; then all get what all photos ask, and each
// takes Adam's step by the mean. That step has one order of sums, so all foams stay the same, bit for bit.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "trainer/cuda/cuda_executor.h"
#include "trainer/cuda/gpu_group.h"

namespace froth {

class MultiGpuExecutor : public StepExecutor {
 public:
  // Whether this machine has so many GPUs, of one kind, and NCCL.
  static Status check(uint32_t gpuCount);
  // As CudaExecutor::make(), on the GPUs 0, 1, ..., gpuCount - 1. Fails as check() does.
  static Result<std::unique_ptr<StepExecutor>> make(uint32_t gpuCount, const FoamStorage<float>& foam,
                                                    std::vector<Photo> photos, bool isDeterministic = false);

  // The number of photos must be a multiple of that of GPUs.
  Status run(const StepPlan& plan) override;
  Status rearrange(const CellPlan& plan) override;
  Status average() override;
  Status takeMeans() override;
  Result<CellFacts> facts() override;
  uint32_t cellCount() const override { return gpus_.front()->cellCount(); }
  Status show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) override;
  Status read(FoamStorage<float>& foam) override;
  Status beginAnew() override;
  Result<uint64_t> droppedCount() override;

  // GPU 0 shows, and tells facts.
  CudaExecutor& gpu(size_t i) { return *gpus_[i]; }

 private:
  MultiGpuExecutor() = default;
  // The first fault. Calls overlap; each has its GPU as that of its thread.
  Status onEach(const std::function<Status(CudaExecutor& gpu, uint32_t index)>& call);
  Status runOnce(const StepPlan& plan, uint32_t share);

  std::vector<std::unique_ptr<CudaExecutor>> gpus_;
  std::unique_ptr<GpuGroup> group_;  // goes before the streams that it works in
};

}  // namespace froth
