// Training that is killed goes on from its last saved state, and ends with the bytes of a run that was left alone.
#include <algorithm>
#include <csignal>
#include <random>

#include "tests/robustness/bake_fixture.h"
#include "tests/tool/shots_fixture.h"

namespace froth::test {
namespace {

class KilledTrain : public ShotsTest {
 protected:
  static constexpr const char *kFoam = "trained.pt", *kState = "trained.state.bin";

  // Cells come and go in step 99.
  static std::vector<std::string> command(bool isResumed) {
    std::vector<std::string> arguments = trainCommand();
    arguments.insert(arguments.begin(), FROTH_TOOL);
    *std::find(arguments.begin(), arguments.end(), "30") = "120";
    arguments.insert(arguments.end(), {"--save-every", "7"});
    if (isResumed) arguments.push_back("--resume");
    return arguments;
  }

  bool hasState() const { return std::filesystem::exists(folder_ / kState); }

  std::mt19937 random_{1};
};

TEST_F(KilledTrain, GoesOnToTheSameBytes) {
  makeShots();
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(ChildProcess(command(false), folder_).wait().exitCode, 0);
  const Seconds whole = since(start);
  const std::string expected = readBytes(folder_ / kFoam);
  std::filesystem::remove(folder_ / kFoam);
  std::filesystem::remove(folder_ / kState);
  const std::vector<std::string> before = filesInFolder();

  int kills = 0, killsOfResumed = 0;
  for (int run = 0; run < 8; ++run) {
    const bool isResumed = hasState();
    const FolderWatch folder(folder_);
    ChildProcess train(command(isResumed), folder_);
    if (run % 2 == 1) folder.waitForFile(Seconds(60));  // so that each other run comes to a state
    sleepFor(std::uniform_real_distribution(0.0, 0.2)(random_) * whole);
    train.send(SIGKILL);
    if (train.wait().signal != SIGKILL) break;  // it was done
    ++kills;
    killsOfResumed += isResumed;
    EXPECT_FALSE(std::filesystem::exists(folder_ / kFoam));
  }
  std::printf("%d runs were killed, %d of them after they went on from a state\n", kills, killsOfResumed);
  ASSERT_GT(killsOfResumed, 0);
  const ProgramEnd last = ChildProcess(command(hasState()), folder_).wait();
  EXPECT_EQ(last.exitCode, 0) << last.text;
  EXPECT_EQ(readBytes(folder_ / kFoam), expected);

  std::vector<std::string> after = filesInFolder();
  std::erase(after, kFoam);
  std::erase(after, kState);
  EXPECT_EQ(after, before);
}

}  // namespace
}  // namespace froth::test
