// Progress and cancellation of long work, as the libraries see it; ProgressPrinter draws it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace froth {

// Called from the working thread, at most a few hundred times per stage. `total` may be 0: unknown.
// Returning false asks the stage to stop; it then fails with ErrorKind::kCancelled.
using Progress = std::function<bool(std::string_view stage, uint64_t done, uint64_t total)>;

inline bool report(const Progress& progress, std::string_view stage, uint64_t done, uint64_t total) {
  return !progress || progress(stage, done, total);
}

// What a stage fails with that was asked to stop; `what` stopped: "bake", "triangulation".
inline Error stoppedOnRequest(const std::string& what) {
  return makeError(ErrorKind::kCancelled, "%s stopped on request", what.c_str());
}

}  // namespace froth
