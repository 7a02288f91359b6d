#include "samples/flythrough/pass_history.h"

#include <string_view>

namespace froth {

void PassHistory::add(const FrothViewStatus& status) {
  if (status.passCount == 0 || (!frames_.empty() && frames_.back().serial == status.serial)) return;
  frames_.push_back(status);
  if (frames_.size() > kFrames) frames_.pop_front();
}

std::vector<PassHistory::Row> PassHistory::passes() const {
  std::vector<Row> rows;
  if (frames_.empty()) return rows;
  const FrothViewStatus& newest = frames_.back();
  for (uint32_t i = 0; i < newest.passCount; ++i) {
    std::vector<double> times;
    for (const FrothViewStatus& frame : frames_) {
      for (uint32_t pass = 0; pass < frame.passCount; ++pass) {
        if (std::string_view(frame.passes[pass].name) == newest.passes[i].name)
          times.push_back(frame.passes[pass].milliseconds);
      }
    }
    rows.push_back({newest.passes[i].name, percentilesOf(std::move(times))});
  }
  return rows;
}

Percentiles PassHistory::total() const {
  std::vector<double> times;
  for (const FrothViewStatus& frame : frames_) {
    double& sum = times.emplace_back(0.0);
    for (uint32_t pass = 0; pass < frame.passCount; ++pass) sum += frame.passes[pass].milliseconds;
  }
  return times.empty() ? Percentiles() : percentilesOf(std::move(times));
}

}  // namespace froth
