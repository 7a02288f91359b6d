#include "host/pass_history.h"

#include <string_view>

namespace froth {

void PassHistory::add(uint64_t serial, std::span<const FrothPassTime> passes) {
  if (passes.empty() || (!frames_.empty() && frames_.back().serial == serial)) return;
  frames_.push_back({serial, {passes.begin(), passes.end()}});
  if (frames_.size() > kFrames) frames_.pop_front();
}

std::vector<PassHistory::Row> PassHistory::passes() const {
  std::vector<Row> rows;
  if (frames_.empty()) return rows;
  for (const FrothPassTime& newest : frames_.back().passes) {
    std::vector<double> times;
    for (const Frame& frame : frames_) {
      for (const FrothPassTime& pass : frame.passes) {
        if (std::string_view(pass.name) == newest.name) times.push_back(pass.milliseconds);
      }
    }
    rows.push_back({newest.name, percentilesOf(std::move(times))});
  }
  return rows;
}

Percentiles PassHistory::total() const {
  std::vector<double> times;
  for (const Frame& frame : frames_) {
    double& sum = times.emplace_back(0.0);
    for (const FrothPassTime& pass : frame.passes) sum += pass.milliseconds;
  }
  return times.empty() ? Percentiles() : percentilesOf(std::move(times));
}

}  // namespace froth
