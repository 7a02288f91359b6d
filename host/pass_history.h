// GPU times of the last frames by pass.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "base/percentiles.h"
#include "froth/froth.h"

namespace froth {

class PassHistory {
 public:
  struct Row {
    const char* name;   // static storage
    Percentiles times;  // [ms]
  };

  // Takes each complete frame once; names are in static storage.
  void add(uint64_t serial, std::span<const FrothPassTime> passes);

  std::vector<Row> passes() const;  // those of the newest frame
  Percentiles total() const;        // zero before the first frame

 private:
  static constexpr size_t kFrames = 240;
  struct Frame {
    uint64_t serial;
    std::vector<FrothPassTime> passes;
  };
  std::deque<Frame> frames_;  // oldest first, at most kFrames
};

}  // namespace froth
