// A step of training on a GPU: what CpuStep does (trainer/cpu/cpu_step.h), with the same functions of trainer/step/.
//
// Calls put work into a stream and return. Nothing is read back within a step: lists have capacities, and a step whose
// lists do not fit changes nothing. settle() tells afterwards, and makes room. Sums are atomic, so two runs differ by
// rounding, unless they are to be of whole numbers (fixed_sums.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "foam/cell_graph.h"
#include "trainer/cpu/foam_storage.h"
#include "trainer/cuda/device_array.h"
#include "trainer/cuda/pass_clock.h"
#include "trainer/cuda/passes.h"
#include "trainer/cuda/step_arrays.h"
#include "trainer/loop/cell_plan.h"

namespace froth {

class CudaStep {
 public:
  CudaStep() = default;
  CudaStep(const CudaStep&) = delete;
  CudaStep& operator=(const CudaStep&) = delete;
  ~CudaStep();

  // Before all others. Fails where there is no GPU. isDeterministic: two runs give the same bits, and take longer.
  Status start(bool isDeterministic = false);
  Status upload(const FoamStorage<float>& foam);
  Status download(FoamStorage<float>& foam);
  Status rearrange(const CellPlan& plan);
  // Of StepExecutor; both between steps.
  Status average();
  Status takeMeans();

  // The calls of a step, in this order. Pointers in `view` and `adam` are to device memory.
  //
  // Balls and pairs, where the last update() did not leave some that hold; waits for the GPU. leastSkin:
  // trainer/step/skin.h.
  Status activate(float leastSkin);
  Status render(const TrainingView<float>& view, const PixelSettings<float>& settings, const AdamStep<float>& adam);
  Status differentiateImage(const ImageTarget& target, const LossTerms& terms);
  Status differentiate();
  // Balls are then those of the next step.
  Status update(const AdamStep<float>& adam, float overlapWeight);

  // In place of update(), in a step of `viewCount` views: the first after each differentiate(), of which view it was;
  // the second when all are kept, here or by copies of other GPUs' blocks, for the eyes of all views. countsBad: as for
  // updateShownByViews().
  Status keepGradients(uint32_t view, uint32_t viewCount, const AdamStep<float>& adam, float overlapWeight);
  Status updateByViews(const std::vector<glm::vec3>& eyes, const AdamStep<float>& adam, bool countsBad);
  // [viewCount * bytesOfKeptView()] in device memory, of the last keepGradients().
  uint8_t* keptViews() { return keptViews_.data(); }
  size_t bytesOfView() const { return bytesOfKeptView(arrays_.foam.shape); }

  // The next step finds pairs as a step that begins with this foam does.
  void forgetPairs() { hasPairs_ = false; }

  // Waits for the GPU. false: the lists of the last step did not fit, so it changed nothing; taken again it will.
  Result<bool> settle();

  // What densification goes by.
  Status downloadFacts(FoamStorage<float>& foam, std::vector<uint32_t>& overlaps);
  Status downloadPairs(CellGraph& graph, std::vector<uint32_t>& reverses);
  Status downloadImage(std::vector<glm::vec4>& rendered) { return rendered_.download(rendered, "rendered", stream_); }
  // In place of differentiateImage().
  Status uploadLoss(const std::vector<glm::vec4>& gradients, const std::vector<glm::vec4>& wanted);

  const StepCounters& counters() const { return lastCounters_; }  // as of settle()
  uint32_t cellCount() const { return arrays_.foam.shape.cellCount; }
  size_t byteCount() const;  // of GPU memory
  cudaStream_t stream() const { return stream_; }
  void setClock(PassClock* clock) { clock_ = clock; }  // null: none

 private:
  Status reservePixels(size_t pixelCount, size_t tileCount);
  Status reserveEntries(uint32_t capacity);
  void point();  // arrays_, at what the arrays are now
  Status mark(Status passed, const char* pass);

  Status reserveCells(const FoamShape& shape);
  Status findPairs(float leastSkin);
  Status clearFixedSums();

  static constexpr size_t kArraysByCell = 7, kArraysByEntry = 4, kArraysByTile = 4;
  struct Tensors {
    DeviceArray<float> values, firstMoments, secondMoments;
    DeviceArray<float> meanValues;  // of averagedSteps_; before the first there are none
  };
  std::array<Tensors, kParameterCount> tensors_;
  uint32_t averagedSteps_ = 0;
  DeviceArray<uint32_t> lastSteps_;
  DeviceArray<glm::vec4> balls_;
  DeviceArray<float> contributions_, errors_;
  DeviceArray<uint32_t> offsets_, neighbours_, reverses_;
  DeviceArray<glm::vec4> foundBalls_, enlargedBalls_;
  DeviceArray<float> slacks_;
  DeviceArray<glm::vec3> boxes_;
  bool hasPairs_ = false;

  DeviceArray<SeenCell<float>> seenCells_;
  DeviceArray<SeenPlane<float>> planes_;
  DeviceArray<SeenDetail<float>> details_;
  DeviceArray<uint32_t> rankOf_, pairOfPlane_;
  DeviceArray<CellSums<float>> cellSums_;
  DeviceArray<DetailSums<float>> detailSums_;
  DeviceArray<glm::vec4> pairSums_;
  bool isDeterministic_ = false;
  DeviceArray<FixedNumber> fixedCellSums_, fixedDetailSums_, fixedPairSums_;
  DeviceArray<glm::vec4> groupCones_;
  DeviceArray<uint32_t> byCell_[kArraysByCell];
  DeviceArray<glm::vec4> tileCones_;
  DeviceArray<uint32_t> tilesBegin_, metEntries_, byEntry_[kArraysByEntry], byTile_[kArraysByTile];
  DeviceArray<glm::vec4> rendered_, gradients_, wanted_;
  DeviceArray<float> logTransmittances_, lossFields_;
  DeviceArray<uint32_t> ends_;
  DeviceArray<StepCounters> counters_;
  DeviceArray<uint8_t> keptViews_;
  Scratch scratch_;

  StepArrays arrays_{};
  TrainingView<float> view_;
  PixelSettings<float> settings_;
  StepCounters lastCounters_;
  PassClock* clock_ = nullptr;
  cudaStream_t stream_ = nullptr;
};

}  // namespace froth
