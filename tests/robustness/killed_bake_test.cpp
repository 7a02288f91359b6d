// A bake that is killed leaves the old file or the whole new one, and its leftovers go with the next bake.
#include <algorithm>
#include <csignal>

#include "tests/robustness/bake_fixture.h"

namespace froth::test {
namespace {

class KilledBake : public BakeTest {
 protected:
  KilledBake() {
    for (int run = 0; run < 3; ++run) measure();
  }

  // The quickest counts: later runs are meant to be struck before they end.
  void measure() {
    const auto start = std::chrono::steady_clock::now();
    const FolderWatch folder(folder_);
    ChildProcess bake(bakeCommand(), folder_);
    EXPECT_TRUE(folder.waitForFile(Seconds(60)));
    const auto firstSign = std::chrono::steady_clock::now();
    EXPECT_EQ(bake.wait().exitCode, 0);
    bakeTime_ = std::min(bakeTime_, since(start));
    writeTime_ = std::min(writeTime_, since(firstSign));
    putOldAsset();
  }

  // At any moment, or at any moment of writing.
  void killOne(bool whileWriting) {
    const FolderWatch folder(folder_);
    ChildProcess bake(bakeCommand(), folder_);
    if (whileWriting) folder.waitForFile(Seconds(60));
    sleepFor(uniform(0, 1) * (whileWriting ? writeTime_ : bakeTime_));
    bake.send(SIGKILL);
    const ProgramEnd end = bake.wait();
    killed_ += end.signal == SIGKILL;

    const std::string found = assetBytes();
    EXPECT_TRUE(found == oldBytes_ || found == newBytes_) << found.size() << " bytes of a partial asset";
    leftFiles_ += end.signal == SIGKILL && filesInFolder().size() > 2;
    leftNew_ += end.signal == SIGKILL && found == newBytes_;
    putOldAsset();
  }

  Seconds bakeTime_ = Seconds::max();   // of a whole run
  Seconds writeTime_ = Seconds::max();  // of its end, from the first sign of it in the folder
  int killed_ = 0, leftFiles_ = 0, leftNew_ = 0;
};

TEST_F(KilledBake, LeavesTheOldAssetOrTheWholeNewOneAndTheNextBakeTidiesUp) {
  const int count = countFrom("FROTH_KILLS", 30);
  int runs = 0;
  for (; killed_ < count && runs < 4 * count; ++runs) killOne(/*whileWriting=*/runs % 2 == 1);
  std::printf(
      "%d of %d bakes were killed (%.3f s each, %.3f s of it writing); %d left files behind, %d a whole new "
      "asset\n",
      killed_, runs, bakeTime_.count(), writeTime_.count(), leftFiles_, leftNew_);
  EXPECT_EQ(killed_, count);

  const ProgramEnd next = ChildProcess(bakeCommand(), folder_).wait();
  EXPECT_EQ(next.exitCode, 0) << next.text;
  EXPECT_EQ(assetBytes(), newBytes_);
  expectNothingLeft();
}

TEST_F(KilledBake, LeavesNoAssetWhereThereWasNone) {
  for (int i = 0; i < 4; ++i) {
    std::filesystem::remove(folder_ / kAsset);
    const FolderWatch folder(folder_);
    ChildProcess bake(bakeCommand(), folder_);
    folder.waitForFile(Seconds(60));
    bake.send(SIGKILL);
    bake.wait();
    const std::string found = assetBytes();
    EXPECT_TRUE(found.empty() || found == newBytes_) << found.size() << " bytes of a partial asset";
  }
}

// Kills seldom strike while a temporary has a name: the asset gathers in a file without one.
TEST_F(KilledBake, WhatOneLeftIsRemovedByTheNextAndNothingElseIs) {
  writeBytes(folder_ / "out.froth.tmp-4711-0", "half an asset");
  writeBytes(folder_ / "out.froth.tmp-mine", "no temporary");
  const ProgramEnd end = ChildProcess(bakeCommand(), folder_).wait();
  EXPECT_EQ(end.exitCode, 0) << end.text;
  EXPECT_EQ(filesInFolder(), (std::vector<std::string>{kCheckpoint, kAsset, "out.froth.tmp-mine"}));
}

// A bake that tidies up must not take the temporaries of one that still runs.
TEST_F(KilledBake, TwoBakesIntoOneNameBothEndWellAndOneOfThemStays) {
  for (int i = 0; i < 6; ++i) {
    ChildProcess first(bakeCommand(), folder_);
    sleepFor(uniform(0, 0.5) * bakeTime_);
    ChildProcess second(bakeCommand({"--near-ratio", "3"}), folder_);
    const ProgramEnd firstEnd = first.wait(), secondEnd = second.wait();
    EXPECT_EQ(firstEnd.exitCode, 0) << firstEnd.text;
    EXPECT_EQ(secondEnd.exitCode, 0) << secondEnd.text;
    const std::string found = assetBytes();
    EXPECT_TRUE(found == oldBytes_ || found == newBytes_);
    expectNothingLeft();
  }
}

}  // namespace
}  // namespace froth::test
