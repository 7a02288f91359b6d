// How far a run is in its schedule.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/progress.h"
#include "trainer/loop/schedule.h"

namespace froth {

// Seconds since some moment; never goes back.
using SecondsClock = std::function<double()>;
double steadySeconds();

// The position of a step is the share of the schedule that is behind it when it begins: steps done of Schedule::steps,
// or, where the schedule has seconds, the share of them that steps have taken. So rates, sizes and numbers of cells
// follow the time, though late steps take many times as long as early ones. Reading, saving and measuring take none.
class Pace {
 public:
  // seconds: of the run that goes on, as seconds() gave them; {0}: a run that begins. Time runs from here on.
  explicit Pace(const Schedule& schedule, SecondsClock clock = steadySeconds, std::vector<double> seconds = {0});

  const Schedule& schedule() const { return schedule_; }
  uint32_t stepsDone() const { return static_cast<uint32_t>(seconds_.size() - 1); }
  // [stepsDone + 1] What the steps before each have taken; the last: all of them.
  const std::vector<double>& seconds() const { return seconds_; }

  // [0..1] Of step 0, 1, ..., up to the one that comes next.
  double positionAt(uint32_t step) const;
  // No step comes next.
  bool isOver() const { return positionAt(stepsDone()) >= 1; }

  void finishStep();
  // Time does not run until goOn().
  void pause();
  void goOn() { lapBegin_ = clock_(); }

  // Between two steps.
  bool reportTo(const Progress& progress) const;

 private:
  double takeLap();

  Schedule schedule_;
  SecondsClock clock_;
  std::vector<double> seconds_;
  double lapBegin_;
};

}  // namespace froth
