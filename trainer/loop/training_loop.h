// The loop of training: which photo at which step, when cells change, when to save.
#pragma once

#include <cstdint>
#include <functional>

#include "base/progress.h"
#include "base/result.h"
#include "trainer/loop/drift_tables.h"
#include "trainer/loop/step_executor.h"

namespace froth {

struct LoopOptions {
  uint64_t seed = 1;
  uint32_t photoCount = 0;  // [>= 1] photos that train
  Eyes eyes = {};
};

// Called after each step with the number of steps done; its time counts as that of steps, unless the pace is paused. An
// error ends the loop.
using AfterStep = std::function<Status(uint32_t done, DriftTables& drifts)>;

// Runs the steps that are left. Fails with kCancelled when `progress` asks to stop, between two steps, so that the
// state can be saved.
Status runLoop(StepExecutor& executor, Pace& pace, const LoopOptions& options, const AfterStep& afterStep,
               const Progress& progress);

// The foam as it stands after `done` steps, with all waiting parameters caught up.
void catchUpAll(FoamStorage<float>& foam, uint32_t done, DriftTables& drifts);

}  // namespace froth
