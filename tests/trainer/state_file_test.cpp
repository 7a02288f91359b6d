// state.bin comes back as it was, or not at all.
#include "trainer/loop/state_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/reference/scenes.h"
#include "trainer/cpu/foam_exchange.h"

namespace froth {
namespace {

class StateFile : public ::testing::Test {
 protected:
  StateFile() : path_(std::filesystem::path(::testing::TempDir()) / "froth_state_test.bin") {
    state_.seconds = {0, 0.5, 0.5, 7};
    state_.settings = "steps 500";
    state_.photosPerStep = 3;
    state_.foam = storeFoam<float>(randomFoam(20, 3, 2, 1));
    state_.foam.secondMoments[5][7] = 1e-30f;
    state_.foam.lastSteps[3] = 100;
    state_.foam.errors[19] = 0.25f;
    EXPECT_TRUE(writeState(path_, state_));
  }
  ~StateFile() override { std::filesystem::remove(path_); }

  std::filesystem::path path_;
  TrainingState state_;
};

TEST_F(StateFile, ComesBackBitForBit) {
  const Result<TrainingState> read = readState(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->seconds, state_.seconds);
  EXPECT_EQ(read->settings, state_.settings);
  EXPECT_EQ(read->photosPerStep, 3u);
  EXPECT_EQ(read->foam.values, state_.foam.values);
  EXPECT_EQ(read->foam.firstMoments, state_.foam.firstMoments);
  EXPECT_EQ(read->foam.secondMoments, state_.foam.secondMoments);
  EXPECT_EQ(read->foam.lastSteps, state_.foam.lastSteps);
  EXPECT_EQ(read->foam.contributions, state_.foam.contributions);
  EXPECT_EQ(read->foam.errors, state_.foam.errors);
}

TEST_F(StateFile, CutAnywhereIsRefused) {
  for (uint64_t size = std::filesystem::file_size(path_); size-- > 0;) {
    if (size > 100 && size % 97 != 0) continue;
    std::filesystem::resize_file(path_, size);
    const Result<TrainingState> read = readState(path_);
    ASSERT_FALSE(read) << size;
    EXPECT_NE(read.error().message.find("froth_state_test.bin"), std::string::npos);
  }
}

TEST_F(StateFile, OfVersion1TellsWhatToDo) {
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(7);
  file.put('1');
  file.close();
  const Result<TrainingState> read = readState(path_);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("version 1"), std::string::npos) << read.error().message;
}

TEST_F(StateFile, OfAFrothThatKnewOnePhotoAStepHasOne) {
  state_.photosPerStep = 0;
  ASSERT_TRUE(writeState(path_, state_));
  const Result<TrainingState> older = readState(path_);
  ASSERT_TRUE(older) << older.error().message;
  EXPECT_EQ(older->photosPerStep, 1u);
  state_.photosPerStep = 17;
  ASSERT_TRUE(writeState(path_, state_));
  EXPECT_FALSE(readState(path_));
}

TEST_F(StateFile, WhoseTimeGoesBackIsRefused) {
  for (const std::vector<double>& seconds :
       {std::vector<double>{0, 3, 2}, {1, 2}, {0, std::nan(""), 2}, {0, 1e308 * 10}}) {
    state_.seconds = seconds;
    ASSERT_TRUE(writeState(path_, state_));
    EXPECT_FALSE(readState(path_)) << seconds.size();
  }
}

}  // namespace
}  // namespace froth
