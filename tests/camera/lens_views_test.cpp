// Lenses in cameras.json, and the rays of their views.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "base/atomic_file.h"
#include "reference/camera/camera.h"
#include "reference/camera/ray_map.h"
#include "reference/camera/view_rays.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class LensViews : public ::testing::Test {
 protected:
  LensViews() {
    folder_ =
        std::filesystem::path(::testing::TempDir()) / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  ~LensViews() override { std::filesystem::remove_all(folder_); }

  static Result<CameraSet> parse(const std::string& fields) {
    const std::string text = "{\"views\": [{" + fields + R"(, "world_from_camera": [[1,0,0,1],[0,1,0,2],[0,0,1,3]]}]})";
    return parseCameras({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, "cameras.json");
  }

  static void expectRefused(const std::string& fields, const std::string& message) {
    const Result<CameraSet> cameras = parse(fields);
    ASSERT_FALSE(cameras) << fields;
    EXPECT_EQ(cameras.error().kind, ErrorKind::kBadInput);
    EXPECT_THAT(cameras.error().message, HasSubstr(message)) << fields;
  }

  std::filesystem::path folder_;
};

constexpr const char* kSize = R"("width": 6, "height": 4)";
constexpr const char* kIntrinsics = R"("width": 6, "height": 4, "fx": 5, "fy": 6, "cx": 3, "cy": 2)";

View someView(LensKind kind, std::vector<double> distortion = {}) {
  View view;
  view.name = "a";
  view.width = 6;
  view.height = 4;
  view.fx = 5;
  view.fy = 6;
  view.cx = 3.25;
  view.cy = 2;
  view.worldFromCamera = {0, 0, 1, 10, -1, 0, 0, -3.5, 0, -1, 0, 1.0 / 3};
  view.lens.kind = kind;
  view.lens.distortion = std::move(distortion);
  return view;
}

TEST_F(LensViews, AreReadBackAsTheyWereWritten) {
  CameraSet written;
  written.views = {someView(LensKind::kPinhole),
                   someView(LensKind::kFisheye),
                   someView(LensKind::kKannalaBrandt, {0.1, -0.2, 0.3, 1.0 / 3}),
                   someView(LensKind::kRadialTangential, {0.1, 0.2, 0.3, 0.4}),
                   someView(LensKind::kRadialTangential, {1, 2, 3, 4, 5, 6, 7, 8}),
                   someView(LensKind::kEquirectangular),
                   someView(LensKind::kOrthographic)};
  ASSERT_TRUE(writeCameras(folder_ / "cameras.json", written));
  const Result<CameraSet> read = readCameras(folder_ / "cameras.json");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->views.size(), written.views.size());
  for (size_t i = 0; i < written.views.size(); ++i) {
    EXPECT_EQ(read->views[i].lens.kind, written.views[i].lens.kind) << i;
    EXPECT_EQ(read->views[i].lens.distortion, written.views[i].lens.distortion) << i;
    EXPECT_EQ(read->views[i].fx, 5) << i;
    EXPECT_EQ(read->views[i].cx, 3.25) << i;
  }
}

TEST_F(LensViews, AnEquirectangularImageWithoutIntrinsicsLooksAllAround) {
  const Result<CameraSet> cameras = parse(std::string(kSize) + R"(, "lens": "equirectangular")");
  ASSERT_TRUE(cameras) << cameras.error().message;
  const View& view = cameras->views[0];
  EXPECT_NEAR(view.fx * 2 * 3.14159265358979, 6, 1e-9);
  EXPECT_NEAR(view.fy * 3.14159265358979, 4, 1e-9);
  const ViewRays rays(view);
  EXPECT_NEAR(rays.at(3, 2)->direction.z, 1, 1e-12);
  EXPECT_NEAR(rays.at(4.5, 2)->direction.x, 1, 1e-12);
  EXPECT_NEAR(rays.at(3, 0)->direction.y, -1, 1e-12);
  EXPECT_NEAR(rays.at(0, 2)->direction.z, -1, 1e-12);
}

TEST_F(LensViews, RaysOfAnOrthographicViewAreParallelAndStartOnItsPlane) {
  const View view = someView(LensKind::kOrthographic);
  const std::optional<ViewRay> ray = ViewRays(view).ofPixel(5, 0);
  ASSERT_TRUE(ray);
  // Camera x is world -y, y is -z, z is x; 5 and 6 pixels per unit.
  EXPECT_EQ(ray->direction, glm::dvec3(1, 0, 0));
  EXPECT_NEAR(ray->offset.x, 0, 1e-15);
  EXPECT_NEAR(ray->offset.y, -(5.5 - 3.25) / 5, 1e-15);
  EXPECT_NEAR(ray->offset.z, -(0.5 - 2.0) / 6, 1e-15);
}

TEST_F(LensViews, AFaultInALensIsNamed) {
  const std::string full(kIntrinsics), size(kSize);
  expectRefused(full + R"(, "lens": "fish")", "field 'lens': found \"fish\"; give \"pinhole\"");
  expectRefused(full + R"(, "lens": 3)", "field 'lens': found 3");
  expectRefused(full + R"(, "lens": [[[[["fisheye"]]]]])", "field 'lens': found a deeply nested array");
  expectRefused(full + R"(, "lens": "kannala_brandt")", "'distortion': found 0");
  expectRefused(full + R"(, "lens": "kannala_brandt", "distortion": [1, 2, 3])", "'distortion': found 3");
  expectRefused(full + R"(, "lens": "radial_tangential", "distortion": [1,2,3,4,5,6])", "'distortion': found 6");
  expectRefused(full + R"(, "lens": "radial_tangential", "distortion": [1,2,"a",4])", "'distortion': found \"a\"");
  expectRefused(full + R"(, "lens": "radial_tangential", "distortion": [1,2,3,4,5,6,7,8,9])", "up to eight");
  expectRefused(full + R"(, "lens": "radial_tangential", "distortion": 4)", "up to eight");
  expectRefused(full + R"(, "distortion": [0.1, 0, 0, 0])", "for a lens without any");
  expectRefused(full + R"(, "lens": "fisheye", "rays": "a.f32")", "'rays': found a file");
  expectRefused(full + R"(, "lens": "ray_map", "rays": "a.f32")", "'fx': found a value");
  expectRefused(size + R"(, "lens": "ray_map")", "'rays': found nothing");
  expectRefused(size + R"(, "lens": "ray_map", "rays": "../a.f32")", "'rays': found \"../a.f32\"");
  expectRefused(size + R"(, "lens": "fisheye")", "'fx': found nothing");
  expectRefused(size + R"(, "lens": "equirectangular", "fx": 3)", "'fy': found nothing");
  expectRefused(size + R"(, "lens": "orthographic", "fx": -3, "fy": 1, "cx": 0, "cy": 0)", "'fx': found -3");
}

TEST_F(LensViews, ARayMapIsReadFromItsFile) {
  RayMap map{3, 2, {{0, 0, 2}, {1, 0, 0}, {0, 0, 0}, {0, 3, 0}, {0, 0, -1}, {3, 0, 4}}};
  ASSERT_TRUE(writeRayMap(folder_ / "rays.f32", map));
  CameraSet cameras;
  cameras.views = {someView(LensKind::kRayMap)};
  View& view = cameras.views[0];
  view.width = 3;
  view.height = 2;
  EXPECT_FALSE(writeCameras(folder_ / "cameras.json", cameras)) << "without a file's name";
  view.lens.raysFile = "rays.f32";
  ASSERT_TRUE(writeCameras(folder_ / "cameras.json", cameras));

  const Result<CameraSet> read = readCameras(folder_ / "cameras.json");
  ASSERT_TRUE(read) << read.error().message;
  const ViewRays rays(read->views[0]);
  // Camera x is world -y, y is -z, z is x.
  EXPECT_EQ(rays.ofPixel(0, 0)->direction, glm::dvec3(1, 0, 0));
  EXPECT_EQ(rays.ofPixel(1, 0)->direction, glm::dvec3(0, -1, 0));
  EXPECT_FALSE(rays.ofPixel(2, 0));
  EXPECT_EQ(rays.ofPixel(0, 1)->direction, glm::dvec3(0, 0, -1));
  EXPECT_LT(glm::length(rays.ofPixel(2, 1)->direction - glm::dvec3(0.8, -0.6, 0)), 1e-7);

  map.directions[4].y = NAN;
  ASSERT_TRUE(writeRayMap(folder_ / "rays.f32", map));
  const Result<CameraSet> bad = readCameras(folder_ / "cameras.json");
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("rays.f32: pixel (1, 1)"));
  map.directions.pop_back();
  ASSERT_TRUE(writeRayMap(folder_ / "rays.f32", map));
  const Result<CameraSet> shorter = readCameras(folder_ / "cameras.json");
  ASSERT_FALSE(shorter);
  EXPECT_THAT(shorter.error().message, HasSubstr("found 60 bytes; give 72"));
  std::filesystem::remove(folder_ / "rays.f32");
  EXPECT_FALSE(readCameras(folder_ / "cameras.json"));
}

TEST_F(LensViews, AResizedRayMapLiesBetweenItsRays) {
  View pinhole = someView(LensKind::kPinhole);
  pinhole.width = 40;
  pinhole.height = 30;
  pinhole.fx = pinhole.fy = 35;
  pinhole.cx = 20;
  pinhole.cy = 15;
  pinhole.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  RayMap map{40, 30, {}};
  for (uint32_t y = 0; y < 30; ++y) {
    for (uint32_t x = 0; x < 40; ++x) map.directions.push_back(ViewRays(pinhole).ofPixel(x, y)->direction);
  }
  map.directions[0] = glm::vec3(0);
  View mapped = pinhole;
  mapped.lens.kind = LensKind::kRayMap;
  mapped.lens.rays = std::make_shared<RayMap>(map);
  for (const uint32_t width : {17u, 40u, 100u}) {
    const View small = resizeView(mapped, width, 45), same = resizeView(pinhole, width, 45);
    ASSERT_EQ(small.lens.rays->directions.size(), size_t{width} * 45);
    const ViewRays found(small), expected(same);
    EXPECT_EQ(!found.ofPixel(0, 0), width >= 40) << "only the nearest ray is missing";
    for (uint32_t y = 3; y < 42; ++y) {
      for (uint32_t x = 3; x < width - 3; ++x) {
        ASSERT_LT(glm::length(found.ofPixel(x, y)->direction - expected.ofPixel(x, y)->direction), 3e-4);
      }
    }
  }
}

}  // namespace
}  // namespace froth
