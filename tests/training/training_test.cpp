// Small scenes train on the CPU, and go on from where they were stopped.
#include <gtest/gtest.h>

#include <filesystem>

#include "foam/foam_arrays.h"
#include "tests/training/gallery_capture.h"
#include "trainer/loop/evaluate.h"

namespace froth {
namespace {

namespace fs = std::filesystem;

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
  EXPECT_GE(meanPsnr(result->testPsnrs), 28);
  EXPECT_EQ(result->foam.cellCount, 4000u);
  EXPECT_EQ(result->droppedCount, 0u);
}

// Without points found in the photos: 9.3 dB, with: 12.6 dB.
TEST(Training, WithoutPointsBeginsWithThoseThatPhotosShow) {
  const test::GalleryCapture gallery = test::makeGalleryCapture(48, 32, false);
  EXPECT_GT(gallery.set.matchedPoints, 500u);
  TrainOptions options;
  options.schedule.steps = 300;
  options.schedule.startCells = 500;
  options.schedule.mostCells = 600;
  options.detailCount = options.lobeCount = 2;
  const Result<TrainResult> result = trainScene(gallery.capture, gallery.set, options, makeCpuExecutor);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GE(meanPsnr(result->testPsnrs), 11.5);
}

// As many photos in half the steps, at rates times the root of 2. By seed the two differ by -0.8 to 0.5 dB.
TEST(Training, InStepsOfTwoPhotosReachesAsMuch) {
  const test::GalleryCapture gallery = test::makeGalleryCapture(48, 32);
  TrainOptions options;
  options.schedule.steps = 800;
  options.schedule.startCells = 1000;
  options.schedule.mostCells = 1200;
  options.detailCount = options.lobeCount = 2;
  std::vector<double> psnrs;
  for (const uint32_t photosPerStep : {1u, 2u}) {
    options.photosPerStep = photosPerStep;
    const Result<TrainResult> result = trainScene(gallery.capture, gallery.set, options, makeCpuExecutor);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->stepsDone, 800 / photosPerStep);
    EXPECT_EQ(result->foam.cellCount, 1200u);
    psnrs.push_back(meanPsnr(result->testPsnrs));
  }
  EXPECT_GT(psnrs[0], 22);
  EXPECT_GT(psnrs[1], psnrs[0] - 1);
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
    ASSERT_GT(meanPsnr(a->testPsnrs), 10);  // something was trained
    visitArrays(
        [&](const FoamArray& array, auto values) { EXPECT_EQ(a->foam.*values, b->foam.*values) << array.name; });
    EXPECT_EQ(a->testPsnrs, b->testPsnrs);
  }

  static const test::GalleryCapture& smallGallery() {
    static const test::GalleryCapture gallery = [] {
      test::GalleryCapture made = test::makeGalleryCapture(24, 16);
      for (auto* photos : {&made.set.training, &made.set.testing}) {
        for (Photo& photo : *photos) photo.view.nearRatio = 1;  // few cells are large, and none would be seen
      }
      return made;
    }();
    return gallery;
  }

  const fs::path folder_;
  const test::GalleryCapture& gallery_ = smallGallery();
  TrainOptions options_;
};

TEST_F(Resume, AfterAStopGivesTheSameBits) {
  const Result<TrainResult> whole = train("whole.bin", false);
  for (const uint64_t stop : {1, 100, 163, 220}) {  // the last: of three steps that are averaged one is done
    const Result<TrainResult> stopped =
        train("stopped.bin", false, [&](std::string_view, uint64_t done, uint64_t) { return done < stop; });
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
    const Result<TrainResult> resumed = train("stopped.bin", true);
    ASSERT_TRUE(resumed) << resumed.error().message;
    expectSame(whole, resumed);
    EXPECT_EQ(resumed->firstStep, stop);
  }
}

// All steps are done, the foam is not written.
TEST_F(Resume, AtTheEndGivesTheSameBits) {
  const Result<TrainResult> whole = train("whole.bin", false);
  const Result<TrainResult> resumed = train("whole.bin", true);
  ASSERT_TRUE(resumed) << resumed.error().message;
  expectSame(whole, resumed);
  EXPECT_EQ(resumed->firstStep, 230u);
}

// By the state: whoever goes on may have another number of GPUs.
TEST_F(Resume, KeepsThePhotosOfAStep) {
  options_.photosPerStep = 2;
  const Result<TrainResult> whole = train("whole.bin", false);
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(whole->stepsDone, 115u);
  ASSERT_FALSE(train("stopped.bin", false, [](std::string_view, uint64_t done, uint64_t) { return done < 60; }));
  options_.photosPerStep = 1;
  const Result<TrainResult> resumed = train("stopped.bin", true);
  expectSame(whole, resumed);
  EXPECT_EQ(resumed->stepsDone, 115u);
}

TEST_F(Resume, AfterAKillGoesOnFromTheLastSavedState) {
  const Result<TrainResult> whole = train("whole.bin", false);
  // What a kill after step 185 leaves is the file of step 140.
  (void)train("killed.bin", false, [&](std::string_view, uint64_t done, uint64_t) {
    if (done == 185) fs::copy_file(folder_ / "killed.bin", folder_ / "left.bin");
    return true;
  });
  const Result<TrainResult> resumed = train("left.bin", true);
  ASSERT_TRUE(resumed) << resumed.error().message;
  expectSame(whole, resumed);
  EXPECT_EQ(resumed->firstStep, 140u);
}

TEST_F(Resume, MeasuringOnTheWayChangesNoBits) {
  const Result<TrainResult> unmeasured = train("a.bin", false);
  std::vector<TrainingMoment> moments;
  options_.measureEvery = 50;
  options_.whenMeasured = [&](const TrainingMoment& moment) -> Status {
    moments.push_back(moment);
    return {};
  };
  const Result<TrainResult> measured = train("b.bin", false);
  expectSame(unmeasured, measured);
  ASSERT_EQ(moments.size(), 5u);
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(moments[i].stepsDone, i < 4 ? 50 * (i + 1) : 230);
  EXPECT_EQ(moments.back().psnr, meanPsnr(measured->testPsnrs));
  EXPECT_EQ(moments.back().cells, 400u);
  EXPECT_GT(moments.back().seconds, moments.front().seconds);
}

TEST_F(Resume, ShowingOnTheWayChangesNoBits) {
  const Result<TrainResult> unshown = train("a.bin", false);
  std::vector<Foam> foams;
  options_.showEvery = 60;
  options_.whenShown = [&](const Foam& foam) -> Status {
    foams.push_back(foam);
    return {};
  };
  const Result<TrainResult> shown = train("b.bin", false);
  expectSame(unshown, shown);
  ASSERT_EQ(foams.size(), 3u);
  EXPECT_EQ(foams[0].cellCount, 300u);
  EXPECT_GT(foams[2].cellCount, 300u);

  // What is shown are the values after a step; the run gives their mean over the last ones, which move by little.
  options_.showEvery = 229;
  ASSERT_TRUE(train("c.bin", false));
  ASSERT_EQ(foams.size(), 4u);
  ASSERT_EQ(foams[3].cellCount, shown->foam.cellCount);
  double distance = 0;
  for (size_t i = 0; i < foams[3].sites.size(); ++i) {
    distance = std::max(distance, double{glm::distance(foams[3].sites[i], shown->foam.sites[i])});
  }
  EXPECT_LT(distance, 0.01);
}

TEST_F(Resume, ARefinementBeginsWhereTheFoamIs) {
  options_.schedule.steps = 400;
  const Result<TrainResult> trained = train("trained.bin", false);
  ASSERT_TRUE(trained) << trained.error().message;
  std::vector<double> psnrs;
  options_.whenMeasured = [&](const TrainingMoment& moment) -> Status {
    psnrs.push_back(moment.psnr);
    return {};
  };
  options_.refined = &trained->foam;
  options_.schedule.steps = 60;
  options_.measureEvery = 1;
  const Result<TrainResult> refined = train("refined.bin", false);
  ASSERT_TRUE(refined) << refined.error().message;
  EXPECT_EQ(refined->foam.cellCount, trained->foam.cellCount);
  EXPECT_EQ(refined->foam.detailCount, 2u);
  EXPECT_NEAR(psnrs.front(), meanPsnr(trained->testPsnrs), 0.01);
  EXPECT_GE(psnrs.back(), meanPsnr(trained->testPsnrs) - 0.3);
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
