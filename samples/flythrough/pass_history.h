// GPU times of the last frames by pass.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "froth/froth.h"
#include "samples/host/percentiles.h"

namespace froth {

class PassHistory {
 public:
  struct Row {
    const char* name;   // static storage
    Percentiles times;  // [ms]
  };

  // Takes each complete frame once.
  void add(const FrothViewStatus& status);

  std::vector<Row> passes() const;  // those of the newest frame
  Percentiles total() const;        // zero before the first frame

 private:
  static constexpr size_t kFrames = 240;
  std::deque<FrothViewStatus> frames_;  // oldest first, at most kFrames
};

}  // namespace froth
