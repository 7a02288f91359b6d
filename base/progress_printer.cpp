#include "base/progress_printer.h"

#include <atomic>
#include <csignal>
#include <cstdio>

#include <unistd.h>

namespace froth {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kTerminalInterval{0.1};
constexpr Seconds kPlainInterval{5.0};

std::atomic<bool> stopRequested{false};  // lock-free, so a signal handler may set it
static_assert(std::atomic<bool>::is_always_lock_free);

void requestStop(int) { stopRequested = true; }

bool isTerminal() {
  static const bool value = isatty(STDERR_FILENO) == 1;
  return value;
}

std::string describeProgress(std::string_view stage, uint64_t done, uint64_t total, double rate) {
  std::string line = std::string(stage) + ": " + std::to_string(done);
  if (total > 0) line += " of " + std::to_string(total);
  if (rate <= 0) return line;
  char text[64];
  std::snprintf(text, sizeof(text), ", %.4g/s", rate);
  line += text;
  if (total <= done) return line;
  std::snprintf(text, sizeof(text), ", %.0f s left", static_cast<double>(total - done) / rate);
  return line + text;
}

}  // namespace

void stopOnInterrupt() {
  struct sigaction action {};
  action.sa_handler = requestStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
}

bool isStopRequested() { return stopRequested; }

Error stoppedError() { return makeError(ErrorKind::kCancelled, "stopped on request; the command can be run again"); }

Progress ProgressPrinter::callback() {
  return [this](std::string_view stage, uint64_t done, uint64_t total) {
    report(stage, done, total);
    return !isStopRequested();
  };
}

void ProgressPrinter::finishLine() {
  const std::lock_guard lock(mutex_);
  if (isLineOpen_) std::fputc('\n', stderr);
  isLineOpen_ = false;
}

void ProgressPrinter::report(std::string_view stage, uint64_t done, uint64_t total) {
  if (isQuiet_) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  const bool isNewStage = stage != stage_;
  if (isNewStage) {
    stage_ = stage;
    rate_.begin(now, done);
    lastDrawn_ = isTerminal() ? Clock::time_point{} : now;  // short stages leave no plain lines
  }
  if (now - lastDrawn_ < (isTerminal() ? kTerminalInterval : kPlainInterval)) return;
  lastDrawn_ = now;
  draw(describeProgress(stage, done, total, rate_.update(now, done)));
}

void ProgressPrinter::draw(const std::string& line) {
  if (isTerminal()) {
    std::fprintf(stderr, "\r\033[K%s", line.c_str());  // \033[K: clears what is left of the old line
    isLineOpen_ = true;
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
  std::fflush(stderr);
}

}  // namespace froth
