// Points that photos show alike, of a scene whose places are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <tbb/global_control.h>

#include "reference/camera/view_rays.h"
#include "tests/trainer_input/capture_sample.h"
#include "trainer/start/match_points.h"
#include "trainer/start/scene_frame.h"

namespace froth {
namespace {

constexpr double kWall = 5, kBoard = 3, kBoardSide = 0.7;  // z; |x| and |y| of the board are less

// Greys between random ones on a lattice, like plaster.
double plasterAt(double x, double y) {
  constexpr double kLattice = 0.25;
  const CounterRandom random(5, Purpose::kColour);
  const double u = x / kLattice + 1000, v = y / kLattice + 1000;
  const auto column = static_cast<uint64_t>(u), row = static_cast<uint64_t>(v);
  const double s = u - double(column), t = v - double(row);
  const auto at = [&](uint64_t i, uint64_t j) { return random.uniform((row + j) * 4096 + column + i); };
  return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

bool isOnBoard(const glm::dvec3& place) { return std::max(std::abs(place.x), std::abs(place.y)) < kBoardSide; }

// What a ray shows: a board before a wall.
double greyOf(const glm::dvec3& eye, const glm::dvec3& direction) {
  const glm::dvec3 board = eye + (kBoard - eye.z) / direction.z * direction;
  const glm::dvec3 wall = eye + (kWall - eye.z) / direction.z * direction;
  return isOnBoard(board) ? plasterAt(board.x + 50, board.y) : plasterAt(wall.x, wall.y);
}

// Eyes on a grid, whose axes are parallel; `spacing` 0: one eye.
Capture wallCapture(double spacing) {
  Capture capture;
  for (int i = 0; i < 12; ++i) {
    const glm::dvec3 eye(spacing * (i % 4 - 1.5), spacing * (i / 4 - 1.0), 0);
    capture.views.push_back(test::viewFrom(eye, eye + glm::dvec3(0, 0, 1), fmt::format("{:03}.png", i)));
  }
  return capture;
}

std::vector<Photo> photosOf(const Capture& capture, bool isPlain = false) {
  std::vector<Photo> photos;
  for (const CapturedView& captured : capture.views) {
    const View& view = captured.view;
    const ViewRays rays(view);
    Photo photo{view, {}, {}};
    for (uint32_t y = 0; y < view.height; ++y) {
      for (uint32_t x = 0; x < view.width; ++x) {
        const double grey = isPlain ? 0.5 : greyOf(eyeOf(view), rays.ofPixel(x, y)->direction);
        photo.rgba.insert(photo.rgba.end(), {uint8_t(255 * grey), uint8_t(255 * grey), uint8_t(255 * grey), 255});
      }
    }
    photos.push_back(std::move(photo));
  }
  return photos;
}

// Share of the points that lie on what the photos show, to 4 % of their depth.
double shareOnSurfaces(const std::vector<CapturedPoint>& points) {
  const auto isRight = [](const CapturedPoint& point) {
    const double z = point.position.z, truth = isOnBoard(point.position) && z < 4 ? kBoard : kWall;
    return std::abs(z - truth) < 0.04 * truth;
  };
  return double(std::count_if(points.begin(), points.end(), isRight)) / double(points.size());
}

TEST(MatchPoints, LieOnWhatThePhotosShow) {
  const Capture capture = wallCapture(0.3);
  const MatchedPoints matched = matchPoints(photosOf(capture), 1);
  ASSERT_GT(matched.points.size(), 500u);
  EXPECT_GT(shareOnSurfaces(matched.points), 0.88);  // 0.916 measured
  const auto onBoard = std::ranges::count_if(matched.points, [](const auto& point) { return point.position.z < 4; });
  EXPECT_GT(onBoard, 40);
  uint64_t first = 0;
  for (const CapturedPoint& point : matched.points) {
    EXPECT_EQ(point.firstObserver, first);
    EXPECT_GE(point.observerCount, 2u);
    first += point.observerCount;
    const auto begin = matched.observers.begin() + ptrdiff_t(point.firstObserver);
    EXPECT_TRUE(std::is_sorted(begin, begin + point.observerCount));
    EXPECT_EQ(point.colour[0], point.colour[2]);
  }
  EXPECT_EQ(first, matched.observers.size());
}

TEST(MatchPoints, AreNotFoundFromOnePlaceNorOnPlainPhotosNorUnderMasks) {
  EXPECT_TRUE(matchPoints(photosOf(wallCapture(0)), 1).points.empty());
  const Capture capture = wallCapture(0.3);
  EXPECT_TRUE(matchPoints(photosOf(capture, true), 1).points.empty());
  std::vector<Photo> masked = photosOf(capture);
  for (Photo& photo : masked) photo.counted.assign(photo.rgba.size() / 4, 0);
  EXPECT_TRUE(matchPoints(masked, 1).points.empty());
  masked = photosOf(capture);
  for (Photo& photo : masked) {
    for (size_t i = 3; i < photo.rgba.size(); i += 4) photo.rgba[i] = 0;
  }
  EXPECT_TRUE(matchPoints(masked, 1).points.empty());
  EXPECT_TRUE(matchPoints({}, 1).points.empty());
}

TEST(MatchPoints, TheSameSeedGivesTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<Photo> photos = photosOf(wallCapture(0.3));
  const MatchedPoints many = matchPoints(photos, 1), other = matchPoints(photos, 2);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
  const MatchedPoints one = matchPoints(photos, 1);
  ASSERT_EQ(many.points.size(), one.points.size());
  for (size_t i = 0; i < one.points.size(); ++i) EXPECT_EQ(many.points[i].position, one.points[i].position);
  EXPECT_EQ(many.observers, one.observers);
  EXPECT_NE(many.points.front().position, other.points.front().position);
}

TEST(MatchPoints, TakeThePlaceOfFewPointsAlone) {
  const Capture bare = wallCapture(0.3);
  const std::vector<Photo> photos = photosOf(bare);
  const std::vector<uint32_t> all = test::allViews(bare);
  const std::vector<uint32_t> training(all.begin() + 1, all.end());
  const std::span<const Photo> trained = std::span(photos).subspan(1);

  Capture coincident = bare;
  test::addPoints(coincident, 400, {0, 0, 5}, 0);
  for (const Capture& few : {bare, coincident}) {
    Capture capture = few;
    const uint32_t found = replaceFewPoints(capture, training, trained, 1);
    ASSERT_GT(found, 400u);
    EXPECT_EQ(capture.points.size(), found);
    EXPECT_EQ(std::ranges::count(capture.observers, 0u), 0);  // the test view
    EXPECT_EQ(std::ranges::max(capture.observers), 11u);
    EXPECT_NEAR(4 / findSceneFrame(capture).scale, kWall, 1);  // the wall tells how far things are
  }
  Capture many = bare;
  test::addPoints(many, 400, {0, 0, 5}, 1);
  EXPECT_EQ(replaceFewPoints(many, training, trained, 1), 0u);
  EXPECT_EQ(many.points.size(), 400u);

  Capture turned = wallCapture(0);
  test::addPoints(turned, 3, {0, 0, 5}, 0);
  const std::vector<Photo> turnedPhotos = photosOf(turned);
  EXPECT_EQ(replaceFewPoints(turned, training, std::span(turnedPhotos).subspan(1), 1), 0u);
  EXPECT_EQ(turned.points.size(), 3u);
}

}  // namespace
}  // namespace froth
