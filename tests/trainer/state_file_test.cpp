// state.bin comes back as it was, or not at all.
#include "trainer/loop/state_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/reference/scenes.h"
#include "trainer/cpu/foam_exchange.h"

namespace froth {
namespace {

class StateFile : public ::testing::Test {
 protected:
  StateFile() : path_(std::filesystem::path(::testing::TempDir()) / "froth_state_test.bin") {
    state_.stepsDone = 123;
    state_.settings = "steps 500";
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
  EXPECT_EQ(read->stepsDone, 123u);
  EXPECT_EQ(read->settings, state_.settings);
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

}  // namespace
}  // namespace froth
