// What changes from step to step: rates, weights of losses, how many cells there should be, how large images are.
// Figures are those of the published recipe, but for the last rates; its 30,000 steps are stretched to as many as are
// asked for, or to as much time. `position`: of a step in its schedule [0..1], as Pace gives it (pace.h).
//
// In the last tenth rates stay high and cells stay the same; the foam that a run gives is the mean of what such steps
// leave (Izmailov et al. 2018, "Averaging Weights Leads to Wider Optima and Better Generalization").
#pragma once

#include <cstdint>

#include "foam/checkpoint/parameters.h"

namespace froth {

inline constexpr uint32_t kMostPhotosPerStep = 16;

enum class RatePreset { kIndoor, kOutdoor };

struct Schedule {
  uint32_t steps = 12000;      // [>= 1]
  uint32_t photosPerStep = 1;  // [1..kMostPhotosPerStep] see spreadSchedule()
  double seconds = 0;          // > 0: as many steps as take so long, in place of `steps`
  uint32_t startCells = 0;     // at step 0
  uint32_t mostCells = 40000;  // from four fifths of the steps on
  RatePreset preset = RatePreset::kIndoor;
  bool isRefinement = false;  // of a trained foam: the second half of a schedule, so rates are low and images whole
};

// The same schedule in steps of so many photos each: it sees as many photos in fewer steps, rounded up. Rates grow by
// the root of the number, as Adam's steps go by a mean of so many gradients, whose noise shrinks by it (the square root
// rule).
Schedule spreadSchedule(Schedule schedule, uint32_t photosPerStep);

// The learning rate of a parameter.
double rateAt(const Schedule& schedule, Parameter parameter, double position);

struct LossWeights {
  double similarity = 0.2, normal = 0.1, sparsity = 0.1, overlap = 1e-4;
};
LossWeights weightsAt(const Schedule& schedule, double position);

// Steps after which cells are removed and added: each in which a hundredth photo is seen, up to the last tenth.
bool isDensifyStep(const Schedule& schedule, uint32_t step, double position);
// How many cells there should be after such a step; `present`: how many there are. A refinement adds from its start on.
uint32_t cellsAfter(const Schedule& schedule, double position, uint32_t present);

// Steps whose values count in the mean: each of the last tenth in which an eighth photo is seen. Positions never go
// back, so cells are never removed or added after one.
bool isAveragedStep(const Schedule& schedule, uint32_t step, double position);

// How often the sides of images are halved: 2, 1, 0. Early steps learn coarse things, and cost less.
uint32_t halvingsAt(const Schedule& schedule, double position);

}  // namespace froth
