// Small scenes train on the CPU, and go on from where they were stopped.
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "foam/foam_arrays.h"
#include "tests/training/gallery_capture.h"

namespace froth {
namespace {

namespace fs = std::filesystem;

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Training, OfTheGalleryReaches28DecibelsOnViewsItDoesNotKnow) {
  const test::GalleryCapture gallery = test::makeGalleryCapture(96, 64);
  TrainOptions options;
  options.schedule.steps = 1000;
  options.schedule.startCells = 3000;
  options.schedule.mostCells = 4000;
  options.detailCount = 4;
  options.lobeCount = 2;
  const Result<TrainResult> result = trainScene(gallery.capture, gallery.set, options, makeCpuExecutor);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GE(meanOf(result->testPsnrs), 28);
  EXPECT_EQ(result->foam.cellCount, 4000u);
  EXPECT_EQ(result->droppedCount, 0u);
}

class Resume : public ::testing::Test {
 protected:
  Resume() : folder_(fs::path(::testing::TempDir()) / "froth_resume") {
    fs::create_directories(folder_);
    options_.schedule.steps = 230;  // two times cells change
    options_.schedule.startCells = 300;
    options_.schedule.mostCells = 400;
    options_.detailCount = options_.lobeCount = 2;
    options_.saveEvery = 70;
  }
  ~Resume() override { fs::remove_all(folder_); }

  Result<TrainResult> train(const std::string& state, bool isResumed, const Progress& progress = {}) {
    options_.state = folder_ / state;
    options_.isResumed = isResumed;
    return trainScene(gallery_.capture, gallery_.set, options_, makeCpuExecutor, progress);
  }

  void expectSame(const Result<TrainResult>& a, const Result<TrainResult>& b) {
    ASSERT_TRUE(a) << a.error().message;
    ASSERT_TRUE(b) << b.error().message;
    visitArrays(
        [&](const FoamArray& array, auto values) { EXPECT_EQ(a->foam.*values, b->foam.*values) << array.name; });
    EXPECT_EQ(a->testPsnrs, b->testPsnrs);
  }

  const fs::path folder_;
  const test::GalleryCapture gallery_ = test::makeGalleryCapture(24, 16);
  TrainOptions options_;
};

TEST_F(Resume, AfterAStopGivesTheSameBits) {
  const Result<TrainResult> whole = train("whole.bin", false);
  for (const uint64_t stop : {1, 100, 163}) {
    const Result<TrainResult> stopped =
        train("stopped.bin", false, [&](std::string_view, uint64_t done, uint64_t) { return done < stop; });
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
    const Result<TrainResult> resumed = train("stopped.bin", true);
    expectSame(whole, resumed);
    EXPECT_EQ(resumed->firstStep, stop);
  }
}

TEST_F(Resume, AfterAKillGoesOnFromTheLastSavedState) {
  const Result<TrainResult> whole = train("whole.bin", false);
  // What a kill after step 185 leaves is the file of step 140.
  (void)train("killed.bin", false, [&](std::string_view, uint64_t done, uint64_t) {
    if (done == 185) fs::copy_file(folder_ / "killed.bin", folder_ / "left.bin");
    return true;
  });
  const Result<TrainResult> resumed = train("left.bin", true);
  expectSame(whole, resumed);
  EXPECT_EQ(resumed->firstStep, 140u);
}

TEST_F(Resume, WithOtherSettingsIsRefused) {
  ASSERT_TRUE(train("state.bin", false));
  options_.seed = 2;
  const Result<TrainResult> other = train("state.bin", true);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("seed 1"), std::string::npos);
}

}  // namespace
}  // namespace froth
