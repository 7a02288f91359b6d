#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "reference/camera/camera.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class CamerasTest : public ::testing::Test {
 protected:
  CamerasTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) / (std::string(test->name()) + ".cameras.json");
  }
  ~CamerasTest() override { std::filesystem::remove(path_); }

  Result<CameraSet> readText(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return readCameras(path_);
  }

  // A valid file whose second view has `field` replaced.
  Result<CameraSet> readWith(const std::string& field, const std::string& value) {
    std::string fields;
    const std::pair<const char*, const char*> defaults[] = {{"width", "640"},
                                                            {"height", "480"},
                                                            {"fx", "500.5"},
                                                            {"fy", "501.5"},
                                                            {"cx", "320"},
                                                            {"cy", "240.25"},
                                                            {"world_from_camera", "[[1,0,0,1],[0,1,0,2],[0,0,1,3]]"}};
    for (const auto& [key, text] : defaults) {
      if (key != field) fields += '"' + std::string(key) + "\": " + text + ", ";
    }
    const std::string first = "{" + fields.substr(0, fields.size() - 2) + "}";
    const std::string good =
        R"({"width":640,"height":480,"fx":5,"fy":5,"cx":3,"cy":2,"world_from_camera":[[1,0,0,1],[0,1,0,2],[0,0,1,3]]})";
    const std::string second = value.empty() ? first : "{" + fields + '"' + field + "\": " + value + "}";
    return readText("{\"views\": [" + good + ", " + second + "]}");
  }

  void expectRefused(const std::string& field, const std::string& value, const std::string& found) {
    const Result<CameraSet> cameras = readWith(field, value);
    ASSERT_FALSE(cameras) << field << " = " << value;
    EXPECT_EQ(cameras.error().kind, ErrorKind::kBadInput);
    EXPECT_THAT(cameras.error().message, HasSubstr(path_.filename().string()));
    EXPECT_THAT(cameras.error().message, HasSubstr("view 1"));
    EXPECT_THAT(cameras.error().message, HasSubstr("'" + field + "'"));
    EXPECT_THAT(cameras.error().message, HasSubstr(found));
    EXPECT_THAT(cameras.error().message, HasSubstr("; "));
  }

  std::filesystem::path path_;
};

View someView() {
  View view;
  view.name = "photo.jpg";
  view.width = 1319;
  view.height = 989;
  view.fx = 1092.3051998417418;
  view.fy = 1092.3052525546593;
  view.cx = 659.5;
  view.cy = 494.5;
  view.worldFromCamera = {0, 0, 1, 1e6 + 0.1, -1, 0, 0, -3.5, 0, -1, 0, 1.0 / 3};
  return view;
}

TEST_F(CamerasTest, WhatIsWrittenIsReadBackToTheLastBit) {
  CameraSet written;
  written.scene = "scenes/somewhere";
  written.views = {someView(), someView()};
  written.views[0].nearDepth = 0.366501418288015;
  written.views[0].nearRatio = 0;
  written.views[0].referencePsnr = 25.148876190185547;
  written.views[0].goldenColour = "view_00_rgb.f16";
  written.views[0].goldenAlpha = "view_00_alpha.f16";
  written.views[0].goldenDepth = "view_00_depth.f16";
  written.flight = {someView()};
  written.flight[0].name = "key 0";
  ASSERT_TRUE(writeCameras(path_, written));

  const Result<CameraSet> read = readCameras(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->scene, written.scene);
  ASSERT_EQ(read->views.size(), 2u);
  ASSERT_EQ(read->flight.size(), 1u);
  EXPECT_EQ(read->flight[0].name, "key 0");
  const View& a = written.views[0];
  const View& b = read->views[0];
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.fx, b.fx);
  EXPECT_EQ(a.fy, b.fy);
  EXPECT_EQ(a.cx, b.cx);
  EXPECT_EQ(a.cy, b.cy);
  EXPECT_EQ(a.worldFromCamera, b.worldFromCamera);
  EXPECT_EQ(a.nearDepth, b.nearDepth);
  EXPECT_EQ(a.nearRatio, b.nearRatio);
  EXPECT_EQ(a.referencePsnr, b.referencePsnr);
  EXPECT_EQ(a.goldenColour, b.goldenColour);
  EXPECT_EQ(a.goldenAlpha, b.goldenAlpha);
  EXPECT_EQ(a.goldenDepth, b.goldenDepth);
  EXPECT_FALSE(read->views[1].nearDepth);
  EXPECT_FALSE(read->views[1].nearRatio);
}

TEST_F(CamerasTest, AViewWithoutAPhotoIsNamedByItsPlace) {
  const Result<CameraSet> cameras = readWith("", "");
  ASSERT_TRUE(cameras) << cameras.error().message;
  EXPECT_EQ(cameras->views[1].name, "view_01");
  EXPECT_EQ(cameras->views[1].fx, 500.5);
  EXPECT_EQ(cameras->views[1].cy, 240.25);
  EXPECT_EQ(cameras->views[1].worldFromCamera[11], 3);
  EXPECT_TRUE(cameras->flight.empty());
}

TEST_F(CamerasTest, TimeGrowsWithTheFileAndNotWithItsSquare) {
  std::string fields = "1";
  for (int i = 0; i < 200000; ++i) fields += ", \"a" + std::to_string(i) + "\": 1";
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(readWith("width", fields));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));  // quadratic: over a minute
}

TEST_F(CamerasTest, AFaultNamesFileViewFieldFoundValueAndRemedy) {
  expectRefused("width", "0", "found 0");
  expectRefused("width", "-640", "found -640");
  expectRefused("width", "640.5", "found 640.5");
  expectRefused("height", "70000", "found 70000");
  expectRefused("height", "1e12", "1000000000000");
  expectRefused("fx", "0", "found 0");
  expectRefused("fy", "-3", "found -3");
  expectRefused("fx", "\"wide\"", "\"wide\"");
  expectRefused("cx", "null", "null");
  expectRefused("cy", "[1]", "[1]");
  expectRefused("near_depth", "-1", "found -1");
  expectRefused("near_ratio", "true", "true");
  expectRefused("near_deph", "0.3", "unknown field");
  expectRefused("photo", "7", "found 7");
  expectRefused("width", "[[[4]]]", "found [[[4]]]");
  const std::string deep(1000000, '[');  // deeper than any stack
  expectRefused("width", deep + std::string(deep.size(), ']'), "found a deeply nested array");
  expectRefused("golden", "7", "found number");
  expectRefused("golden", R"({"rgb": "../../etc/passwd"})", "passwd");
  expectRefused("golden", R"({"normal": "n.f16"})", "unknown field");
}

TEST_F(CamerasTest, AMissingFieldIsNamed) {
  const Result<CameraSet> cameras = readText(R"({"views": [{"width": 3, "height": 4}]})");
  ASSERT_FALSE(cameras);
  EXPECT_THAT(cameras.error().message, HasSubstr("view 0, field 'fx': found nothing"));
}

TEST_F(CamerasTest, PosesThatAreNoRotationAreRefused) {
  expectRefused("world_from_camera", "[[1,0,0],[0,1,0],[0,0,1]]", "[[1,0,0]");
  expectRefused("world_from_camera", "[[2,0,0,0],[0,2,0,0],[0,0,2,0]]", "product of columns 0 and 0 is 4");
  expectRefused("world_from_camera", "[[1,0.01,0,0],[0,1,0,0],[0,0,1,0]]", "columns 0 and 1");
  expectRefused("world_from_camera", "[[1,0,0,0],[0,1,0,0],[0,0,-1,0]]", "-1");
  expectRefused("world_from_camera", "[[0,0,0,0],[0,0,0,0],[0,0,0,0]]", "is 0");
  EXPECT_TRUE(readWith("world_from_camera", "[[1,0.00004,0,0],[0,1,0,0],[0,0,1,0]]"));
}

TEST_F(CamerasTest, AFileThatIsNotCamerasIsRefusedWithItsName) {
  for (const char* text :
       {"", "{", "[]", "7", "{\"views\": 3}", "{}", "{\"views\": [7]}", "{\"views\": [], \"flight\": {}}",
        "{\"views\": [{\"fx\": 1e999}]}", "{\"views\": [NaN]}", "\x89PNG\r\n"}) {
    const Result<CameraSet> cameras = readText(text);
    ASSERT_FALSE(cameras) << text;
    EXPECT_EQ(cameras.error().kind, ErrorKind::kBadInput) << text;
    EXPECT_THAT(cameras.error().message, HasSubstr(path_.filename().string())) << text;
  }
  EXPECT_FALSE(readCameras(::testing::TempDir()));
  EXPECT_FALSE(readCameras(path_.string() + ".absent"));
}

TEST_F(CamerasTest, DeeplyNestedJsonDoesNotExhaustTheStack) { EXPECT_FALSE(readText(std::string(200000, '['))); }

TEST_F(CamerasTest, AViewThatCouldNotBeReadBackIsNotWritten) {
  CameraSet cameras;
  cameras.views = {someView()};
  cameras.views[0].cx = NAN;
  const Status status = writeCameras(path_, cameras);
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("'cx'"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(CamerasTest, AKeyThatComesTwiceIsRefused) {
  for (const char* text : {R"({"views": [], "views": []})", R"({"views": [{"width": 1, "width": 2}]})",
                           R"({"views": [], "x": {"a": [{"b": 1, "c": {"b": 2}, "b": 3}]}})"}) {
    const Result<CameraSet> cameras = readText(text);
    ASSERT_FALSE(cameras) << text;
    EXPECT_THAT(cameras.error().message, HasSubstr("stands twice in one object")) << text;
  }
  EXPECT_TRUE(readText(R"({"views": [], "x": [{"a": 1}, {"a": {"a": 2}}]})"));
}

TEST_F(CamerasTest, AFileOfMoreThan32MebibytesIsRefusedUnread) {
  ASSERT_FALSE(readText(R"({"views": 1})"));
  std::filesystem::resize_file(path_, (uint64_t{32} << 20) + 1);
  const Result<CameraSet> cameras = readCameras(path_);
  ASSERT_FALSE(cameras);
  EXPECT_THAT(cameras.error().message, HasSubstr("has 33554433 bytes, more than 33554432"));
}

TEST(ResizeView, ScalesTheIntrinsicsAndKeepsTheNearLimits) {
  View view = someView();
  view.nearDepth = 0.3;
  const View half = resizeView(view, 2638, 494);
  EXPECT_EQ(half.width, 2638u);
  EXPECT_EQ(half.height, 494u);
  EXPECT_DOUBLE_EQ(half.fx, 2 * view.fx);
  EXPECT_DOUBLE_EQ(half.cx, 2 * view.cx);
  EXPECT_DOUBLE_EQ(half.fy, view.fy * 494 / 989);
  EXPECT_DOUBLE_EQ(half.cy, view.cy * 494 / 989);
  EXPECT_EQ(half.nearDepth, 0.3);
  EXPECT_EQ(half.worldFromCamera, view.worldFromCamera);
}

TEST(RealCameras, ThePublishedViewsAreRead) {
  const std::filesystem::path root = test::dataFolder();
  if (!std::filesystem::exists(root / "foams")) FROTH_SKIP() << "no data at " << root << "; set FROTH_DATA";
  const Result<CameraSet> miku = readCameras(root / "foams/miku_plush/cameras.json");
  ASSERT_TRUE(miku) << miku.error().message;
  EXPECT_EQ(miku->views.size(), 13u);
  EXPECT_EQ(miku->views[6].goldenColour, "view_06_rgb.f16");
  EXPECT_NEAR(*miku->views[0].nearDepth, 0.3665, 1e-4);
  const Result<CameraSet> tankard = readCameras(root / "foams/tankard_rough/cameras.json");
  ASSERT_TRUE(tankard) << tankard.error().message;
  EXPECT_EQ(tankard->views.size(), 9u);
}

}  // namespace
}  // namespace froth
