#include "trainer/loop/schedule.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace froth {
namespace {

constexpr double kPublishedSteps = 30000;
constexpr double kRefinementBegin = 0.5;   // of a schedule
constexpr double kRefinementWarmUp = 0.1;  // of a refinement
constexpr double kLeastWarmUpSteps = 100;  // of one that lasts a number of steps, and not of seconds
// Of a schedule: cells come and go no more, and steps are averaged. One number, for a mean is of the same cells.
constexpr double kAveragingBegin = 0.9;
constexpr uint64_t kDensifyPeriod = 100, kAveragingPeriod = 8;  // [photos]

// Last rates are four times the published ones: the values move about more, so that their mean is of more places.
struct Rate {
  double first, last;
  double warmUp = 0;  // of the published steps
};

Rate rateOf(RatePreset preset, Parameter parameter) {
  const bool isOutdoor = preset == RatePreset::kOutdoor;
  switch (parameter) {
    case Parameter::kPoints:
      return isOutdoor ? Rate{1e-3, 4e-4} : Rate{1e-3, 2e-4};
    case Parameter::kDensity:
      return {1, 1, 1000};
    case Parameter::kRadii:
      return isOutdoor ? Rate{1e-4, 4e-5, 1000} : Rate{5e-5, 2e-5, 1000};
    case Parameter::kOrientations:
      return {1e-1, 4e-2};
    case Parameter::kDetailSites:
      return {1e-2, 4e-3};
    case Parameter::kLobeAxes:
      return isOutdoor ? Rate{1e-2, 4e-3} : Rate{5e-2, 2e-2};
    case Parameter::kLobeColours:
      return isOutdoor ? Rate{2e-3, 8e-4} : Rate{5e-3, 2e-3};
    case Parameter::kDetailHeights:
      return isOutdoor ? Rate{1e-2, 4e-3, 2000} : Rate{5e-3, 2e-3, 2000};
  }
  return {};
}

// In a whole schedule.
double progressOf(const Schedule& schedule, double position) {
  return schedule.isRefinement ? kRefinementBegin + (1 - kRefinementBegin) * position : position;
}

double rateOfOnePhoto(const Schedule& schedule, Parameter parameter, double position) {
  const Rate rate = rateOf(schedule.preset, parameter);
  const double progress = progressOf(schedule, position), warmUp = rate.warmUp / kPublishedSteps;
  if (progress < warmUp) return rate.first * progress / warmUp;
  const double cosine = std::cos(std::numbers::pi * (progress - warmUp) / (1 - warmUp));
  const double now = rate.last + 0.5 * (rate.first - rate.last) * (1 + cosine);
  if (!schedule.isRefinement) return now;
  // Adam's first steps move each parameter by its whole rate, whatever its gradient: moments are 0.
  const double leastWarmUp = schedule.seconds > 0 ? 0 : kLeastWarmUpSteps / schedule.steps;
  return now * std::min(1.0, position / std::max(kRefinementWarmUp, leastWarmUp));
}

// Whether the photos of a step bring their number to a multiple of `period`, or past one.
bool fillsPeriod(const Schedule& schedule, uint32_t step, uint64_t period) {
  const uint64_t before = uint64_t{step} * schedule.photosPerStep, after = before + schedule.photosPerStep;
  return after / period > before / period;
}

}  // namespace

Schedule spreadSchedule(Schedule schedule, uint32_t photosPerStep) {
  schedule.steps = (schedule.steps - 1) / photosPerStep + 1;
  schedule.photosPerStep = photosPerStep;
  return schedule;
}

double rateAt(const Schedule& schedule, Parameter parameter, double position) {
  return std::sqrt(double{1} * schedule.photosPerStep) * rateOfOnePhoto(schedule, parameter, position);
}

LossWeights weightsAt(const Schedule& schedule, double position) {
  const double progress = progressOf(schedule, position);
  LossWeights weights;
  weights.normal *= std::pow(0.1, progress);
  weights.sparsity *= std::pow(1e-3, progress);
  weights.overlap *= std::pow(1e-3, progress);
  return weights;
}

bool isDensifyStep(const Schedule& schedule, uint32_t step, double position) {
  return fillsPeriod(schedule, step, kDensifyPeriod) && progressOf(schedule, position) < kAveragingBegin;
}

bool isAveragedStep(const Schedule& schedule, uint32_t step, double position) {
  return fillsPeriod(schedule, step, kAveragingPeriod) && progressOf(schedule, position) >= kAveragingBegin;
}

uint32_t cellsAfter(const Schedule& schedule, double position, uint32_t present) {
  const double first = schedule.isRefinement ? kRefinementBegin : 1000 / kPublishedSteps;
  const double last = 24000 / kPublishedSteps, now = progressOf(schedule, position);
  if (now < first) return present;
  const double share = std::min((now - first) / (last - first), 1.0);
  const double start = schedule.startCells;
  return static_cast<uint32_t>(std::lround(start * std::pow(schedule.mostCells / start, share)));
}

uint32_t halvingsAt(const Schedule& schedule, double position) {
  if (schedule.isRefinement) return 0;
  return position < 0.1 ? 2 : position < 0.4 ? 1 : 0;
}

}  // namespace froth
