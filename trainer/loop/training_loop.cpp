#include "trainer/loop/training_loop.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "trainer/photos/photo_order.h"
#include "trainer/step/cell_update.h"

namespace froth {
namespace {

// Cells move by up to about a rate per step and axis: a skin for some ten steps, in which the graph is not looked for.
constexpr double kSkinSteps = 10;

StepPlan planStep(const LoopOptions& options, uint32_t step, uint32_t photo, DriftTables& drifts) {
  StepPlan plan;
  plan.photo = photo;
  plan.halvings = halvingsAt(options.schedule, step);
  plan.adam = drifts.adamAt(step);
  plan.weights = weightsAt(options.schedule, step);
  plan.leastSkin = static_cast<float>(kSkinSteps * rateAt(options.schedule, Parameter::kPoints, step));
  return plan;
}

Status densify(StepExecutor& executor, const LoopOptions& options, uint32_t step) {
  const Result<CellFacts> facts = executor.facts();
  if (!facts) return facts.error();
  const uint32_t wanted = cellsAfter(options.schedule, step, static_cast<uint32_t>(facts->balls.size()));
  const CellPlan plan = planCells(*facts, wanted, options.seed, step);
  if (plan.sources.empty()) {
    return makeError(ErrorKind::kBadInput, "training: after %u steps no cell is seen; check poses and near limits",
                     step + 1);
  }
  return executor.rearrange(plan);
}

}  // namespace

Status runLoop(StepExecutor& executor, const LoopOptions& options, const AfterStep& afterStep,
               const Progress& progress) {
  DriftTables drifts(options.schedule);
  std::vector<uint32_t> order;
  uint64_t orderOf = UINT64_MAX;
  for (uint32_t step = options.firstStep; step < options.schedule.steps; ++step) {
    if (!report(progress, "train", step, options.schedule.steps)) return stoppedOnRequest("training");
    const uint64_t epoch = step / options.photoCount;
    if (epoch != orderOf) order = epochOrder(options.photoCount, options.seed, epoch);
    orderOf = epoch;
    const StepPlan plan = planStep(options, step, order[step % options.photoCount], drifts);
    if (Status ran = executor.run(plan); !ran) return ran;
    if (isDensifyStep(options.schedule, step)) {
      if (Status changed = densify(executor, options, step); !changed) return changed;
    }
    if (Status went = afterStep(step + 1, drifts); !went) return went;
  }
  return {};
}

void catchUpAll(FoamStorage<float>& foam, uint32_t done, DriftTables& drifts) {
  const AdamStep<float> adam = drifts.adamAt(done);
  const TrainedFoam<float> view = viewStorage(foam);
  tbb::parallel_for(0u, foam.shape.cellCount, [&](uint32_t cell) { catchUpCell(view, adam, cell); });
}

}  // namespace froth
