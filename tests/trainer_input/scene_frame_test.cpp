#include <gtest/gtest.h>

#include "reference/camera/view_rays.h"
#include "tests/trainer_input/capture_sample.h"
#include "trainer/start/scene_frame.h"

namespace froth {
namespace {

TEST(SceneFrame, PointsDecideWithoutOutliers) {
  Capture capture = test::orbit(12, {100, 50, -20}, 30);
  test::addPoints(capture, 300, {100, 50, -20}, 2);
  for (CapturedPoint& point : capture.points) {
    if (&point - capture.points.data() < 40) point.position = {1e6, 1e7, 0};
  }
  const SceneFrame frame = findSceneFrame(capture);
  EXPECT_LT(glm::distance(frame.centre, {100, 50, -20}), 1);
  EXPECT_NEAR(frame.scale, 4.0 / 30, 0.01);
}

TEST(SceneFrame, CamerasDecideWhereThereAreNoPoints) {
  const SceneFrame around = findSceneFrame(test::orbit(12, {100, 50, -20}, 30));
  EXPECT_LT(glm::distance(around.centre, {100, 50, -20}), 0.1);
  EXPECT_NEAR(around.scale, 4.0 / 30, 0.01);

  // All look outwards: their axes meet behind them.
  Capture outwards;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 eye(std::cos(i * 0.785), 0, std::sin(i * 0.785));
    outwards.views.push_back(test::viewFrom(eye, 2.0 * eye, "a"));
  }
  const SceneFrame out = findSceneFrame(outwards);
  EXPECT_LT(glm::length(out.centre), 1e-2);
  EXPECT_NEAR(out.scale, 4.0 / 3, 0.02);

  // One camera turned around: nothing tells the scale.
  Capture turned;
  for (int i = 0; i < 8; ++i) {
    turned.views.push_back(test::viewFrom({1, 2, 3}, {1 + std::cos(i * 0.785), 2, 3 + std::sin(i * 0.785)}, "a"));
  }
  const SceneFrame turn = findSceneFrame(turned);
  EXPECT_LT(glm::distance(turn.centre, {1, 2, 3}), 1e-9);
  EXPECT_NEAR(turn.scale, 4, 1e-6);

  for (CapturedView& view : turned.views) {
    const glm::dvec3 eye(4.1, 2.9, 1.5);  // whose mean is rounded
    for (int axis = 0; axis < 3; ++axis) view.view.worldFromCamera[4 * size_t(axis) + 3] = eye[axis];
  }
  turned.views.resize(7);
  EXPECT_NEAR(findSceneFrame(turned).scale, 4, 1e-6);

  Capture parallel;
  for (int i = 0; i < 5; ++i) parallel.views.push_back(test::viewFrom({i, 0, 0}, {i, 0, 9}, "a"));
  const SceneFrame side = findSceneFrame(parallel);
  EXPECT_TRUE(std::isfinite(side.scale) && side.scale > 0);
}

TEST(SceneFrame, EyesLieInABallAroundTheirMean) {
  const Capture capture = test::orbit(12, {100, 50, -20}, 30);
  const SceneFrame frame{{90, 50, -20}, 0.5};
  const Eyes eyes = findEyes(capture, frame);
  EXPECT_NEAR(eyes.centre.x, 5, 0.1);
  EXPECT_GE(eyes.radius, 14.9f);
  EXPECT_LE(eyes.radius, 15.1f);
}

TEST(SceneFrame, FoamsComeBack) {
  const SceneFrame frame{{100, -50, 20}, 0.125};
  Foam foam;
  foam.sites = {{101, -49, 25}, {0, 1, 2}};
  foam.radii = {0.5f, 2};
  foam.densities = {8, 0.25f};
  const Foam moved = normalisedFoam(foam, frame);
  EXPECT_EQ(moved.sites[0], glm::vec3(0.125f, 0.125f, 0.625f));
  EXPECT_EQ(moved.radii[1], 0.25f);
  EXPECT_EQ(moved.densities[0], 64);  // a ray through the cell is absorbed as before
  const Foam back = sceneFoam(moved, frame);
  EXPECT_EQ(back.sites, foam.sites);
  EXPECT_EQ(back.radii, foam.radii);
  EXPECT_EQ(back.densities, foam.densities);
}

TEST(SceneFrame, ViewsKeepTheirRays) {
  const Capture capture = test::orbit(3, {5, 6, 7}, 30);
  const SceneFrame frame{{1, 2, 3}, 0.5};
  const View moved = normalised(capture.views[1].view, frame);
  EXPECT_LT(glm::distance(eyeOf(moved), (eyeOf(capture.views[1].view) - frame.centre) * 0.5), 1e-12);
  EXPECT_EQ(forwardOf(moved), forwardOf(capture.views[1].view));
}

}  // namespace
}  // namespace froth
