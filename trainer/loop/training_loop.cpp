#include "trainer/loop/training_loop.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "trainer/photos/photo_order.h"
#include "trainer/step/cell_update.h"

namespace froth {
namespace {

// Cells move by up to about a rate per step and axis: a skin for some ten steps, in which the graph is not looked for.
constexpr double kSkinSteps = 10;

// Of the step that comes next.
StepPlan planStep(const Pace& pace, PhotoSequence& photos, DriftTables& drifts) {
  const Schedule& schedule = pace.schedule();
  const double position = pace.positionAt(pace.stepsDone());
  StepPlan plan;
  plan.photos = photos.ofStep(pace.stepsDone(), schedule.photosPerStep);
  plan.halvings = halvingsAt(schedule, position);
  plan.adam = drifts.adamAt(pace.stepsDone());
  plan.weights = weightsAt(schedule, position);
  plan.leastSkin = static_cast<float>(kSkinSteps * rateAt(schedule, Parameter::kPoints, position));
  return plan;
}

Status densify(StepExecutor& executor, const Pace& pace, const LoopOptions& options) {
  const uint32_t step = pace.stepsDone();
  const Result<CellFacts> facts = executor.facts();
  if (!facts) return facts.error();
  const uint32_t wanted =
      cellsAfter(pace.schedule(), pace.positionAt(step), static_cast<uint32_t>(facts->balls.size()));
  const CellPlan plan = planCells(*facts, wanted, options.eyes, options.seed, step);
  if (plan.sources.empty()) {
    return makeError(ErrorKind::kBadInput,
                     "training: after %u steps no cell has finite numbers; report the scene that does this", step + 1);
  }
  return executor.rearrange(plan);
}

}  // namespace

Status runLoop(StepExecutor& executor, Pace& pace, const LoopOptions& options, const AfterStep& afterStep,
               const Progress& progress) {
  DriftTables drifts(pace, options.eyes);
  PhotoSequence photos(options.photoCount, options.seed);
  while (!pace.isOver()) {
    if (!pace.reportTo(progress)) return stoppedOnRequest("training");
    const uint32_t step = pace.stepsDone();
    if (Status ran = executor.run(planStep(pace, photos, drifts)); !ran) return ran;
    if (isDensifyStep(pace.schedule(), step, pace.positionAt(step))) {
      if (Status changed = densify(executor, pace, options); !changed) return changed;
    }
    if (isAveragedStep(pace.schedule(), step, pace.positionAt(step))) {
      if (Status averaged = executor.average(); !averaged) return averaged;
    }
    pace.finishStep();
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
