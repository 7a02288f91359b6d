// How fast long work goes.
#pragma once

#include <chrono>
#include <cstdint>

namespace froth {

// Over the last 10 to 20 seconds, or since the last item if that takes longer: later items may cost more than the
// first, and work that goes on begins with items that another run did.
class ProgressRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void begin(Time now, uint64_t done) { before_ = last_ = {now, done}; }

  // Items per second; 0: not known yet.
  double update(Time now, uint64_t done) {
    if (done < last_.done) begin(now, done);
    if (done > last_.done && now - last_.time >= std::chrono::seconds(10)) {
      before_ = last_;
      last_ = {now, done};
    }
    const double elapsed = std::chrono::duration<double>(now - before_.time).count();
    return elapsed > 0 ? static_cast<double>(done - before_.done) / elapsed : 0;
  }

 private:
  struct Mark {
    Time time;
    uint64_t done = 0;
  };
  Mark before_, last_;
};

}  // namespace froth
