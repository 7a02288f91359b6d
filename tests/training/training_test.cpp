// Small scenes train on the CPU, and go on from where they were stopped.
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "tests/training/gallery_capture.h"
#include "trainer/loop/train_scene.h"

namespace froth {
namespace {

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Training, OfTheGalleryReaches28Decibels) {
  const test::GalleryCapture gallery = test::makeGalleryCapture(96, 64);
  TrainOptions options;
  options.schedule.steps = std::getenv("STEPS") ? uint32_t(atoi(std::getenv("STEPS"))) : 600;
  options.schedule.mostCells = 3000;
  options.schedule.startCells = 2000;
  options.detailCount = 4;
  options.lobeCount = 2;
  const Result<TrainResult> result =
      trainScene(gallery.capture, gallery.set, options, makeCpuExecutor, [](auto stage, uint64_t done, uint64_t total) {
        if (done % 50 == 0) std::printf("%s %lu %lu\n", std::string(stage).c_str(), done, total), fflush(stdout);
        return true;
      });
  ASSERT_TRUE(result) << result.error().message;
  for (double p : result->testPsnrs) std::printf("%g ", p);
  std::printf("cells %u dropped %lu\n", result->foam.cellCount, result->droppedCount);
  EXPECT_GE(meanOf(result->testPsnrs), 28);
}

}  // namespace
}  // namespace froth
