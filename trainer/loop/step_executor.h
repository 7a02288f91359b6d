// Who executes the steps of training: the CPU (cpu_executor.h) or a GPU (trainer/cuda). The loop plans, and looks at
// cells only when some are to be removed and added, saved or shown.
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "trainer/cpu/foam_storage.h"
#include "trainer/loop/cell_plan.h"
#include "trainer/loop/schedule.h"
#include "trainer/photos/photos.h"
#include "trainer/step/adam.h"

namespace froth {

struct StepPlan {
  std::vector<uint32_t> photos;  // [>= 1] indices of training photos; the step is by the mean of their losses
  uint32_t halvings = 0;         // of their sides
  AdamStep<float> adam;
  LossWeights weights;
  float leastSkin = 0;  // trainer/cpu/skin_pairs.h
};

// One thread calls.
class StepExecutor {
 public:
  virtual ~StepExecutor() = default;

  // May return before the step is done; a fault of it may come from a later call.
  virtual Status run(const StepPlan& plan) = 0;
  // Replaces the cells by those of a plan made from facts(). Forgets mean values, which are of the cells before.
  virtual Status rearrange(const CellPlan& plan) = 0;
  // Counts the values of all parameters, as they are stored, in their means (trainer/step/running_mean.h).
  virtual Status average() = 0;
  // The means become the values, if any step was averaged; none comes after. No value waits then: what first moments
  // would yet move it by belongs to the last step's values, so those moments become 0.
  virtual Status takeMeans() = 0;
  // Of all steps that were run. Valid until the next call.
  virtual Result<CellFacts> facts() = 0;
  virtual uint32_t cellCount() const = 0;
  // What a view in the normalised scene sees of the foam: colour over black, transmittance. `adam`: of the step that
  // comes next. Later steps give the bits that they would give without this call.
  virtual Status show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) = 0;
  // All arrays, as the steps left them.
  virtual Status read(FoamStorage<float>& foam) = 0;
  // From here on the steps give the same bits as those of an executor that begins with what read() gave.
  virtual Status beginAnew() = 0;
  // Contributions dropped because they were no finite numbers.
  virtual Result<uint64_t> droppedCount() = 0;
};

}  // namespace froth
