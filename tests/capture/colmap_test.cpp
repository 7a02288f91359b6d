// Models that COLMAP could have written become views, lenses and points.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reference/camera/view_rays.h"
#include "tests/capture/colmap_sample.h"

namespace froth {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

Capture valueOf(const Result<Capture>& capture) {
  if (capture) return *capture;
  ADD_FAILURE() << capture.error().message;
  return {};
}

TEST(Colmap, ViewsAreSortedByNameAndKeepTheirCameras) {
  const Capture capture = valueOf(parseModel(test::binaryModel({})));
  ASSERT_EQ(capture.views.size(), 3u);
  EXPECT_EQ(capture.views[0].view.name, "a/1.jpg");
  EXPECT_EQ(capture.views[1].view.name, "b 2.jpg");
  EXPECT_EQ(capture.views[2].view.name, "c.jpg");
  const View& radial = capture.views[0].view;
  EXPECT_EQ(radial.width, 320u);
  EXPECT_EQ(radial.lens.kind, LensKind::kRadialTangential);
  const View& pinhole = capture.views[2].view;
  EXPECT_EQ(pinhole.lens.kind, LensKind::kPinhole);
  EXPECT_EQ(pinhole.fx, 500.5);
  EXPECT_EQ(pinhole.fy, 501);
  EXPECT_EQ(pinhole.cx, 321);
  EXPECT_EQ(pinhole.cy, 239);
}

TEST(Colmap, PosesAreInvertedAndPointsKeepWhoSeesThem) {
  const Capture capture = valueOf(parseModel(test::binaryModel({})));
  ASSERT_EQ(capture.views.size(), 3u);
  // Half a turn about x, x_cam = (x, -y, -z) + (1, 2, 3): the eye is where that is 0.
  EXPECT_THAT(capture.views[0].view.worldFromCamera, ElementsAre(1, 0, 0, -1, 0, -1, 0, 2, 0, 0, -1, 3));
  ASSERT_EQ(capture.points.size(), 2u);
  EXPECT_EQ(capture.points[0].position, glm::dvec3(1, 2, 3));
  EXPECT_THAT(capture.points[1].colour, ElementsAre(255, 0, 1));
  EXPECT_EQ(capture.points[0].observerCount, 2u);  // image 5 twice in the track
  EXPECT_EQ(capture.points[1].firstObserver, 2u);
  EXPECT_THAT(capture.observers, ElementsAre(0, 2, 1));
}

TEST(Colmap, TextGivesTheSameAsBinary) {
  const Capture binary = valueOf(parseModel(test::binaryModel({}))), text = valueOf(parseModel(test::textModel({})));
  ASSERT_EQ(text.views.size(), binary.views.size());
  for (size_t i = 0; i < text.views.size(); ++i) {
    const View &a = text.views[i].view, &b = binary.views[i].view;
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.fx, b.fx);
    EXPECT_EQ(a.lens.distortion, b.lens.distortion);
    EXPECT_EQ(a.worldFromCamera, b.worldFromCamera);
  }
  ASSERT_EQ(text.points.size(), binary.points.size());
  EXPECT_EQ(text.points[1].position, binary.points[1].position);
  EXPECT_EQ(text.observers, binary.observers);
}

// COLMAP's projection of a place in the camera's axes, written from its documentation of camera models.
glm::dvec2 project(const test::SampleCamera& camera, const glm::dvec3& place) {
  const std::vector<double>& p = camera.parameters;
  const std::string model = camera.modelName;
  const bool hasOne = model.find("SIMPLE") == 0 || model == "RADIAL" || model == "RADIAL_FISHEYE";
  const double fx = p[0], fy = hasOne ? p[0] : p[1];
  const size_t at = hasOne ? 1 : 2;
  const auto k = [&](size_t i) { return at + 2 + i < p.size() ? p[at + 2 + i] : 0; };
  double u = place.x / place.z, v = place.y / place.z;
  if (model.find("FISHEYE") != std::string::npos) {
    const double r = std::hypot(u, v), theta = std::atan(r), t2 = theta * theta;
    const double bent = theta * (1 + k(0) * t2 + k(1) * t2 * t2 + k(2) * t2 * t2 * t2 + k(3) * t2 * t2 * t2 * t2);
    u *= bent / r;
    v *= bent / r;
  } else if (model == "SIMPLE_RADIAL" || model == "RADIAL") {
    const double r2 = u * u + v * v, factor = 1 + k(0) * r2 + k(1) * r2 * r2;
    u *= factor;
    v *= factor;
  } else if (model == "OPENCV" || model == "FULL_OPENCV") {
    const double r2 = u * u + v * v, r4 = r2 * r2, r6 = r4 * r2;
    const double factor = (1 + k(0) * r2 + k(1) * r4 + k(4) * r6) / (1 + k(5) * r2 + k(6) * r4 + k(7) * r6);
    const double du = 2 * k(2) * u * v + k(3) * (r2 + 2 * u * u), dv = 2 * k(3) * u * v + k(2) * (r2 + 2 * v * v);
    u = u * factor + du;
    v = v * factor + dv;
  }
  return {fx * u + p[at], fy * v + p[at + 1]};
}

TEST(Colmap, RaysOfEveryModelMeetThePlacesThatItProjects) {
  const test::SampleCamera cameras[] = {
      {1, 0, "SIMPLE_PINHOLE", 640, 480, {400, 310, 250}},
      {1, 1, "PINHOLE", 640, 480, {400, 420, 310, 250}},
      {1, 2, "SIMPLE_RADIAL", 640, 480, {400, 310, 250, -0.16}},
      {1, 3, "RADIAL", 640, 480, {400, 310, 250, 0.1, -0.05}},
      {1, 4, "OPENCV", 640, 480, {400, 420, 310, 250, 0.06, -0.08, -1e-3, 2e-3}},
      {1, 5, "OPENCV_FISHEYE", 640, 480, {400, 420, 310, 250, 0.05, -0.02, 0.004, -0.001}},
      {1, 6, "FULL_OPENCV", 640, 480, {400, 420, 310, 250, 0.06, -0.08, -1e-3, 2e-3, 0.01, 0.02, -0.01, 0.003}},
      {1, 8, "SIMPLE_RADIAL_FISHEYE", 640, 480, {400, 310, 250, 0.05}},
      {1, 9, "RADIAL_FISHEYE", 640, 480, {400, 310, 250, 0.05, -0.02}}};
  for (const test::SampleCamera& camera : cameras) {
    test::SampleModel model;
    model.cameras = {camera};
    model.images = {{1, {1, 0, 0, 0}, {0, 0, 0}, 1, "a.jpg"}};
    model.points.clear();
    for (const test::ModelBytes& bytes : {test::binaryModel(model), test::textModel(model)}) {
      const Capture capture = valueOf(parseModel(bytes));
      ASSERT_EQ(capture.views.size(), 1u) << camera.modelName;
      const ViewRays rays(capture.views[0].view);
      for (const glm::dvec3& place : {glm::dvec3(0.3, -0.2, 1), glm::dvec3(-0.5, 0.4, 1), glm::dvec3(0.7, 0.5, 1)}) {
        const glm::dvec2 pixel = project(camera, place);
        const std::optional<ViewRay> ray = rays.at(pixel.x, pixel.y);
        ASSERT_TRUE(ray) << camera.modelName;
        EXPECT_LT(glm::distance(ray->direction, glm::normalize(place)), 1e-9) << camera.modelName;
      }
    }
  }
}

}  // namespace
}  // namespace froth
