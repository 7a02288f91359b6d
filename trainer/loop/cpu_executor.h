// Steps on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "trainer/cpu/cpu_step.h"
#include "trainer/loop/step_executor.h"
#include "trainer/loss/image_loss.h"
#include "trainer/photos/photos.h"

namespace froth {

class CpuExecutor : public StepExecutor {
 public:
  // `photos` are those that train, with views in the normalised scene; smaller ones are made of them when they are
  // needed. Both are kept.
  CpuExecutor(FoamStorage<float> foam, std::vector<Photo> photos);

  Status run(const StepPlan& plan) override;
  Status rearrange(const CellPlan& plan) override;
  Status average() override;
  Status takeMeans() override;
  Result<CellFacts> facts() override;
  uint32_t cellCount() const override { return foam_.shape.cellCount; }
  Status show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) override;
  Status read(FoamStorage<float>& foam) override;
  Status beginAnew() override;
  Result<uint64_t> droppedCount() override { return step_.droppedCount(); }

 private:
  struct PhotoTarget {
    Photo photo;
    std::vector<float> directions;
    std::vector<glm::vec4> wanted;  // PixelArrays::wanted
  };
  const PhotoTarget& targetOf(uint32_t photo, uint32_t halvings);
  void differentiate(uint32_t photo, const StepPlan& plan);

  FoamStorage<float> foam_;
  CpuStep<float> step_{foam_};
  std::vector<Photo> photos_;
  std::vector<PhotoTarget> targets_;
  uint32_t halvings_ = UINT32_MAX;  // of targets_
  ImageLoss<float> loss_;
  std::vector<glm::vec4> gradients_;
  std::vector<uint32_t> overlaps_;         // of facts()
  std::unique_ptr<CpuStep<float>> shown_;  // what show() draws with, until cells change
};

}  // namespace froth
