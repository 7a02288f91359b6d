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

  void addMeans(uint32_t steps) {
    state_.foam.averagedSteps = steps;
    state_.foam.meanValues = state_.foam.values;
    state_.foam.meanValues[2][4] = -0.125f;
    EXPECT_TRUE(writeState(path_, state_));
  }
  void expectCutsAreRefused();

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
  EXPECT_EQ(read->foam.averagedSteps, 0u);
  EXPECT_TRUE(read->foam.meanValues[0].empty());
}

TEST_F(StateFile, OfARunWithMeanValuesHasThem) {
  const uint64_t without = std::filesystem::file_size(path_);
  addMeans(2);
  const Result<TrainingState> read = readState(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->foam.averagedSteps, 2u);
  EXPECT_EQ(read->foam.meanValues, state_.foam.meanValues);
  EXPECT_EQ(read->foam.values, state_.foam.values);
  EXPECT_EQ(read->foam.errors, state_.foam.errors);
  size_t values = 0;
  for (const std::vector<float>& tensor : state_.foam.values) values += tensor.size();
  EXPECT_EQ(std::filesystem::file_size(path_), without + values * sizeof(float));
}

TEST_F(StateFile, OfMoreMeansThanStepsIsRefused) {
  addMeans(3);  // of three steps
  EXPECT_TRUE(readState(path_));
  addMeans(4);
  EXPECT_FALSE(readState(path_));
}

TEST_F(StateFile, ThatOnlySaysThatItHasMeansIsRefused) {
  state_.foam.averagedSteps = 2;
  ASSERT_TRUE(writeState(path_, state_));
  EXPECT_FALSE(readState(path_));
}

TEST_F(StateFile, WithMeanValuesCutAnywhereIsRefused) {
  addMeans(2);
  expectCutsAreRefused();
}

TEST_F(StateFile, CutAnywhereIsRefused) { expectCutsAreRefused(); }

void StateFile::expectCutsAreRefused() {
  for (uint64_t size = std::filesystem::file_size(path_); size-- > 0;) {
    if (size > 100 && size % 97 != 0) continue;
    std::filesystem::resize_file(path_, size);
    const Result<TrainingState> read = readState(path_);
    ASSERT_FALSE(read) << size;
    EXPECT_NE(read.error().message.find("froth_state_test.bin"), std::string::npos);
  }
}

TEST_F(StateFile, OfAnOlderVersionTellsWhatToDo) {
  for (const char version : {'1', '2'}) {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(7);
    file.put(version);
    file.close();
    const Result<TrainingState> read = readState(path_);
    ASSERT_FALSE(read);
    const std::string found = std::string("version ") + version + ", this froth reads version 3";
    EXPECT_NE(read.error().message.find(found), std::string::npos) << read.error().message;
  }
}

TEST_F(StateFile, OfNoPhotosAStepOrTooManyIsRefused) {
  for (const uint32_t photosPerStep : {0u, 17u}) {
    state_.photosPerStep = photosPerStep;
    ASSERT_TRUE(writeState(path_, state_));
    EXPECT_FALSE(readState(path_)) << photosPerStep;
  }
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
