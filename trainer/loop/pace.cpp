#include "trainer/loop/pace.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace froth {

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Pace::Pace(const Schedule& schedule, SecondsClock clock, std::vector<double> seconds)
    : schedule_(schedule), clock_(std::move(clock)), seconds_(std::move(seconds)), lapBegin_(clock_()) {}

double Pace::positionAt(uint32_t step) const {
  if (schedule_.seconds > 0) return std::min(seconds_[step] / schedule_.seconds, 1.0);
  return double{1} * step / schedule_.steps;
}

double Pace::takeLap() {
  const double now = clock_();
  return now - std::exchange(lapBegin_, now);
}

void Pace::finishStep() { seconds_.push_back(seconds_.back() + takeLap()); }

void Pace::pause() { seconds_.back() += takeLap(); }

bool Pace::reportTo(const Progress& progress) const {
  if (schedule_.seconds == 0) return report(progress, "train", stepsDone(), schedule_.steps);
  const auto done = static_cast<uint64_t>(seconds_.back()), all = static_cast<uint64_t>(std::ceil(schedule_.seconds));
  return report(progress, "train, seconds", done, all);
}

}  // namespace froth
