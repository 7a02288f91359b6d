#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/trainer_input/capture_sample.h"
#include "trainer/photos/photo_order.h"

namespace froth {
namespace {

using ::testing::ElementsAre;

TEST(PhotoOrder, EveryEighthTestsFromTheFirst) {
  const Capture capture = test::orbit(18, {0, 0, 0}, 4);
  const Result<PhotoSplit> split = splitPhotos(capture.views);
  ASSERT_TRUE(split);
  EXPECT_THAT(split->test, ElementsAre(0, 8, 16));
  EXPECT_EQ(split->training.size(), 15u);
  const Result<PhotoSplit> none = splitPhotos(capture.views, 0);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->training.size(), 18u);
}

TEST(PhotoOrder, WhatTheCaptureSaysGoesFirst) {
  Capture capture = test::orbit(5, {0, 0, 0}, 4);
  capture.views[1].part = capture.views[2].part = CapturePart::kTraining;
  capture.views[4].part = CapturePart::kTest;
  const Result<PhotoSplit> split = splitPhotos(capture.views);
  ASSERT_TRUE(split);
  EXPECT_THAT(split->training, ElementsAre(1, 2));
  EXPECT_THAT(split->test, ElementsAre(4));
}

TEST(PhotoOrder, OnePhotoIsTooFew) {
  EXPECT_FALSE(splitPhotos(test::orbit(2, {0, 0, 0}, 4).views));
  EXPECT_FALSE(splitPhotos(test::orbit(1, {0, 0, 0}, 4).views, 0));
  EXPECT_TRUE(splitPhotos(test::orbit(2, {0, 0, 0}, 4).views, 0));
}

TEST(PhotoOrder, EpochsArePermutationsThatDiffer) {
  std::vector<uint32_t> sorted(97);
  std::iota(sorted.begin(), sorted.end(), 0u);
  std::vector<std::vector<uint32_t>> orders = {epochOrder(97, 1, 0), epochOrder(97, 1, 1), epochOrder(97, 2, 0)};
  EXPECT_EQ(orders[0], epochOrder(97, 1, 0));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NE(orders[i], orders[(i + 1) % 3]);
    EXPECT_NE(orders[i], sorted);
  }
  for (std::vector<uint32_t>& order : orders) {
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, sorted);
  }
}

TEST(PhotoOrder, StepsOfSeveralPhotosGoThroughTheSameEpochs) {
  std::vector<uint32_t> epochs = epochOrder(7, 1, 0);
  for (const uint32_t photo : epochOrder(7, 1, 1)) epochs.push_back(photo);
  for (const uint32_t photosPerStep : {1u, 2u, 3u}) {
    PhotoSequence sequence(7, 1);
    std::vector<uint32_t> photos;
    for (uint32_t step = 0; photos.size() < epochs.size(); ++step) {
      const std::vector<uint32_t> more = sequence.ofStep(step, photosPerStep);
      ASSERT_EQ(more.size(), photosPerStep);
      photos.insert(photos.end(), more.begin(), more.end());
    }
    photos.resize(epochs.size());
    EXPECT_EQ(photos, epochs) << photosPerStep;
  }
}

}  // namespace
}  // namespace froth
