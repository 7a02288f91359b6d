// Where a place is seen is where its ray comes from.
#include <gtest/gtest.h>

#include "reference/camera/view_points.h"
#include "reference/camera/view_rays.h"

namespace froth {
namespace {

View viewWith(LensKind kind, std::vector<double> distortion) {
  View view;
  view.width = 200;
  view.height = 100;
  view.fx = 90;
  view.fy = 95;
  view.cx = 104;
  view.cy = 47;
  view.lens.kind = kind;
  view.lens.distortion = std::move(distortion);
  view.worldFromCamera = {0, 0, 1, 5, -1, 0, 0, 6, 0, -1, 0, 7};
  return view;
}

TEST(ViewPoints, AreWhereTheirRaysComeFrom) {
  const View views[] = {viewWith(LensKind::kPinhole, {}), viewWith(LensKind::kFisheye, {}),
                        viewWith(LensKind::kKannalaBrandt, {0.05, -0.02, 0.004, -0.001}),
                        viewWith(LensKind::kRadialTangential, {0.06, -0.02, -1e-3, 2e-3}),
                        viewWith(LensKind::kEquirectangular, {})};
  for (const View& view : views) {
    const ViewRays rays(view);
    const ViewPoints points(view);
    for (const glm::dvec2& pixel : {glm::dvec2(10.25, 90.5), glm::dvec2(104, 47), glm::dvec2(150.75, 20)}) {
      const std::optional<ViewRay> ray = rays.at(pixel.x, pixel.y);
      ASSERT_TRUE(ray);
      const std::optional<glm::dvec2> point = points.of(eyeOf(view) + 3.5 * ray->direction);
      ASSERT_TRUE(point);
      EXPECT_LT(glm::distance(*point, pixel), 1e-6) << static_cast<int>(view.lens.kind);
    }
  }
}

TEST(ViewPoints, PlacesBehindAndBesideAreNotSeen) {
  const View view = viewWith(LensKind::kPinhole, {});
  const ViewPoints points(view);
  EXPECT_TRUE(points.of({9, 6, 7}));  // it looks along x
  EXPECT_FALSE(points.of({1, 6, 7}));
  for (const glm::dvec3& place : {glm::dvec3(6, 16, 7), {6, -4, 7}, {6, 6, 17}, {6, 6, -3}}) {
    EXPECT_FALSE(points.of(place));
  }
  EXPECT_FALSE(points.of({5, 6, 7}));  // in the eye
  EXPECT_FALSE(ViewPoints(viewWith(LensKind::kOrthographic, {})).of({9, 6, 7}));
  // Far off the axis this distortion folds the image over.
  EXPECT_FALSE(ViewPoints(viewWith(LensKind::kRadialTangential, {-0.5, 0, 0, 0})).of({6, 6.97, 7}));
}

}  // namespace
}  // namespace froth
