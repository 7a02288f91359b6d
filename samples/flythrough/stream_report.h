// What streaming did during a headless flight.
#pragma once

#include <nlohmann/json.hpp>

#include "samples/flythrough/options.h"
#include "samples/flythrough/streaming.h"

namespace froth {

class StreamReport {
 public:
  // `options` outlives it.
  StreamReport(const FlythroughOptions& options, uint32_t levelCount) : options_(options), levelCount_(levelCount) {}

  void add(const StreamFigures& figures);  // a frame
  // One line for assets with levels, and the file of --json if there is one. At least one frame was added.
  Status finish() const;

 private:
  const FlythroughOptions& options_;
  uint32_t levelCount_;
  uint32_t settledFrames_ = 0;
  StreamFigures last_;
  nlohmann::ordered_json frames_ = nlohmann::ordered_json::array();
};

}  // namespace froth
