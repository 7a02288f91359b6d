// Ctrl-C ends a bake within a second, and it is as if it had never run.
#include <algorithm>
#include <csignal>

#include "tests/robustness/bake_fixture.h"

namespace froth::test {
namespace {

constexpr Seconds kPatience{1};  // of a machine that does nothing else
constexpr Seconds kStart{0.1};   // of a process: the loader's, before it can set a handler

class StoppedBake : public BakeTest {
 protected:
  StoppedBake() : BakeTest(std::to_string(countFrom("FROTH_STOP_CELLS", 3000))) {}

  void stopOne(const std::vector<std::string>& options, Seconds wholeTime) {
    ChildProcess bake(bakeCommand(options), folder_);
    const Seconds moment = uniform(0, 1) * wholeTime;
    sleepFor(moment);
    bake.send(SIGINT);
    const auto start = std::chrono::steady_clock::now();
    const ProgramEnd end = bake.wait();
    slowest_ = std::max(slowest_, since(start));
    EXPECT_LT(since(start), busyness_ * kPatience)
        << "stopped at " << moment.count() << " of " << wholeTime.count() << " s";
    expectNothingLeft();
    if (end.exitCode == 0) return putOldAsset();  // too late
    ++stopped_;
    if (end.signal == SIGINT) {
      EXPECT_LT(moment, busyness_ * kStart);
    } else {
      EXPECT_EQ(end.exitCode, 1) << "signal " << end.signal << ": " << end.text;
      EXPECT_NE(end.text.find("stopped on request"), std::string::npos) << end.text;
    }
    EXPECT_EQ(assetBytes(), oldBytes_);
  }

  void stopMany(const std::vector<std::string>& options) {
    const auto start = std::chrono::steady_clock::now();
    const ProgramEnd whole = ChildProcess(bakeCommand(options), folder_).wait();
    ASSERT_EQ(whole.exitCode, 0) << whole.text;
    const Seconds wholeTime = since(start);
    busyness_ = std::max(1.0, wholeTime / whole.cpuTime);
    putOldAsset();
    const int count = countFrom("FROTH_STOPS", 5);
    for (int i = 0; i < count; ++i) stopOne(options, wholeTime);
    std::printf(
        "%d of %d bakes of %.2f s stopped in time; the slowest end took %.3f s on a machine %.1f times "
        "busy\n",
        stopped_, count, wholeTime.count(), slowest_.count(), busyness_);
    EXPECT_GT(stopped_, 0);
  }

  double busyness_ = 1;  // how many others the machine serves beside the bake
  int stopped_ = 0;
  Seconds slowest_{};
};

TEST_F(StoppedBake, EndsWithinASecondAndLeavesNothingBehind) { stopMany({"--preset", "exact"}); }

TEST_F(StoppedBake, EndsWithinASecondAlsoWhileItWeighsAppearance) { stopMany({"--preset", "default"}); }

}  // namespace
}  // namespace froth::test
