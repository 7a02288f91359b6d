// Exposures of photos of a scene whose colours are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/camera/view_points.h"
#include "reference/camera/view_rays.h"
#include "tests/trainer_input/capture_sample.h"
#include "trainer/photos/exposure.h"

namespace froth {
namespace {

constexpr uint32_t kViews = 12;
constexpr double kRadius = 1;

// A ball's colour, by the direction from its centre.
glm::dvec3 colourAt(const glm::dvec3& direction) {
  return 0.35 + 0.2 * glm::dvec3(std::sin(3 * direction.x), std::sin(2 * direction.y + 1), std::cos(3 * direction.z));
}

// Photo i is brighter by these.
glm::dvec3 exposureOf(uint32_t i) { return glm::dvec3(0.25, 0.2, 0.3) * std::sin(2.0 * i); }

class Exposure : public ::testing::Test {
 protected:
  Exposure() : capture_(test::orbit(kViews, glm::dvec3(0), 3)) {
    for (uint32_t i = 0; i < kViews; ++i) photos_.push_back(photoOf(capture_.views[i].view, exposureOf(i)));
    const CounterRandom random(1, Purpose::kSite);
    for (uint32_t i = 0; i < 400; ++i) addPoint(random.direction(i));
    for (uint32_t i = 0; i < kViews; ++i) mean_ += exposureOf(i) / double(kViews);
  }

  // The ball in white surroundings.
  static Photo photoOf(const View& view, const glm::dvec3& exposure) {
    const ViewRays rays(view);
    Photo photo{view, {}, {}};
    for (uint32_t y = 0; y < view.height; ++y) {
      for (uint32_t x = 0; x < view.width; ++x) {
        const glm::dvec3 eye = eyeOf(view), ray = rays.ofPixel(x, y)->direction;
        const double along = -glm::dot(eye, ray), miss = glm::dot(eye, eye) - along * along;
        glm::dvec3 colour(1);
        if (miss < kRadius) colour = glm::exp(exposure) * colourAt(eye + (along - std::sqrt(kRadius - miss)) * ray);
        for (int c = 0; c < 3; ++c) photo.rgba.push_back(uint8_t(std::lround(255 * std::min(colour[c], 1.0))));
        photo.rgba.push_back(255);
      }
    }
    return photo;
  }

  // Seen where the ball does not hide it, and not beside its edge.
  void addPoint(const glm::dvec3& place) {
    CapturedPoint point{place, {}, capture_.observers.size(), 0};
    for (uint32_t i = 0; i < kViews; ++i) {
      if (glm::dot(place, eyeOf(capture_.views[i].view)) < 2) continue;
      capture_.observers.push_back(i);
      ++point.observerCount;
    }
    capture_.points.push_back(point);
  }

  void expectExposures(double tolerance) {
    const Result<std::vector<glm::dvec3>> found = findExposures(capture_, photos_);
    ASSERT_TRUE(found) << found.error().message;
    for (uint32_t i = 0; i < kViews; ++i) {
      EXPECT_LT(glm::length((*found)[i] - (exposureOf(i) - mean_)), tolerance) << i;
    }
  }

  Capture capture_;
  std::vector<Photo> photos_;  // of all views
  glm::dvec3 mean_{0};
};

TEST_F(Exposure, IsFoundFromPointsThatSeveralPhotosShow) { expectExposures(0.02); }

TEST_F(Exposure, IsFoundAmongObserversThatSeeAnotherPlace) {
  const CounterRandom random(2, Purpose::kSite);
  for (const CapturedPoint& point : capture_.points) {
    if (point.observerCount == 0 || point.firstObserver % 5 != 0) continue;
    capture_.observers[point.firstObserver] = uint32_t(random.uniform(point.firstObserver) * kViews);
  }
  expectExposures(0.06);
}

TEST_F(Exposure, IsTakenAwayAndTheBallLooksTheSameInAllPhotos) {
  ASSERT_TRUE(evenExposures(capture_, photos_));
  for (uint32_t i = 0; i < kViews; ++i) {
    const Photo same = photoOf(photos_[i].view, mean_);
    int most = 0;
    for (size_t k = 0; k < same.rgba.size(); ++k) {
      if (same.rgba[k] < 240) most = std::max(most, std::abs(int(photos_[i].rgba[k]) - int(same.rgba[k])));
    }
    EXPECT_LE(most, 6) << i;
  }
}

TEST_F(Exposure, OfPhotosThatShowFewPointsIsZero) {
  for (uint32_t& observer : capture_.observers) {
    if (observer == 3) observer = 4;
  }
  const Result<std::vector<glm::dvec3>> found = findExposures(capture_, photos_);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ((*found)[3], glm::dvec3(0));
  EXPECT_GT(glm::length((*found)[4]), 0.1);
}

TEST_F(Exposure, CountsNoPixelThatAMaskIgnoresOrThatIsClipped) {
  for (Photo& photo : photos_) {
    photo.counted.assign(photo.rgba.size() / 4, 0);
  }
  const Result<std::vector<glm::dvec3>> found = findExposures(capture_, photos_);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("--even-exposure"), std::string::npos) << found.error().message;
  for (Photo& photo : photos_) {
    photo.counted.clear();
    std::fill(photo.rgba.begin(), photo.rgba.end(), uint8_t{255});
  }
  EXPECT_FALSE(findExposures(capture_, photos_));
}

TEST_F(Exposure, LeavesColoursBelowAlpha) {
  Photo photo{photos_[0].view, {100, 50, 20, 120}, {}};
  removeExposure(glm::dvec3(-1, 0, 1), photo);
  EXPECT_EQ(photo.rgba, (std::vector<uint8_t>{120, 50, 7, 120}));
}

}  // namespace
}  // namespace froth
