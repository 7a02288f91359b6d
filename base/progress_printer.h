// Draws the progress of long work on stderr, and turns Ctrl-C into a request to stop.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "base/progress.h"
#include "base/progress_rate.h"
#include "base/result.h"

namespace froth {

// From now on Ctrl-C asks the running work to stop at its next report; a second Ctrl-C ends the process.
void stopOnInterrupt();
bool isStopRequested();
Error stoppedError();

// On a terminal one line that is drawn over; otherwise a plain line every few seconds. Thread safe.
class ProgressPrinter {
 public:
  void setQuiet() { isQuiet_ = true; }
  // What the libraries call; refers to this printer. Asks them to stop after Ctrl-C.
  Progress callback();
  // Ends a line that is being drawn, so that other output starts on its own.
  void finishLine();

 private:
  using Clock = std::chrono::steady_clock;

  void report(std::string_view stage, uint64_t done, uint64_t total);
  void draw(const std::string& line);

  std::mutex mutex_;
  bool isQuiet_ = false;
  bool isLineOpen_ = false;
  std::string stage_;
  ProgressRate rate_;  // of the stage
  Clock::time_point lastDrawn_;
};

}  // namespace froth
