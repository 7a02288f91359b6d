// transforms.json as nerfstudio and instant-ngp write it, whole and spoilt.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/image/image.h"
#include "reference/capture/capture.h"
#include "reference/capture/view_selection.h"

namespace froth {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kPose = "[[1,0,0,4],[0,1,0,5],[0,0,1,6],[0,0,0,1]]";

class TransformsTest : public ::testing::Test {
 protected:
  TransformsTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("froth_transforms_") + test->name());
    fs::create_directories(folder_);
  }
  ~TransformsTest() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void writePhoto(const std::string& name, uint32_t width, uint32_t height) {
    fs::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(writeImage(folder_ / name, Image{width, height, 3, std::vector<float>(size_t{3} * width * height)}));
  }

  static std::string frame(const std::string& path, const std::string& more = "") {
    return "{\"file_path\": \"" + path + "\", \"transform_matrix\": " + kPose + more + "}";
  }

  Result<Capture> readWith(const std::string& fields, const std::string& frames) {
    write("transforms.json", "{" + fields + (fields.empty() ? "" : ", ") + "\"frames\": [" + frames + "]}");
    return readCapture(folder_);
  }

  void expectBad(const std::string& fields, const std::string& frames, const std::vector<std::string>& parts) {
    const Result<Capture> capture = readWith(fields, frames);
    ASSERT_FALSE(capture) << parts[0];
    EXPECT_EQ(capture.error().kind, ErrorKind::kBadInput);
    for (const std::string& part : parts) EXPECT_THAT(capture.error().message, HasSubstr(part));
  }

  fs::path folder_;
};

constexpr const char* kIntrinsics = "\"w\": 640, \"h\": 480.0, \"fl_x\": 500, \"fl_y\": 510, \"cx\": 322, \"cy\": 236";

// A file that is named and not there is no fault.
TEST_F(TransformsTest, PointsAreThoseOfTheFileThatItNames) {
  writePhoto("a.png", 640, 480);
  const std::string fields = std::string(kIntrinsics) + ", \"ply_file_path\": \"points/sparse_pc.ply\"";
  Result<Capture> capture = readWith(fields, frame("a.png"));
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_TRUE(capture->points.empty());
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  write("points/sparse_pc.ply", header + "1 2 3\n4 5 6\n");
  capture = readWith(fields, frame("a.png"));
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->points.size(), 2u);
  EXPECT_EQ(capture->points[1].position, glm::dvec3(4, 5, 6));  // poses have the same axes
  write("points/sparse_pc.ply", header + "1.5 2.5 3.5\n");
  expectBad(fields, frame("a.png"), {"sparse_pc.ply", "vertex 1", "found no number"});
  expectBad(std::string(kIntrinsics) + ", \"ply_file_path\": \"../a.ply\"", frame("a.png"),
            {"ply_file_path", "'../a.ply'"});
  expectBad(std::string(kIntrinsics) + ", \"ply_file_path\": 3", frame("a.png"), {"ply_file_path", "found 3"});
}

TEST_F(TransformsTest, AxesTurnFromRightUpBackToRightDownForward) {
  const Result<Capture> capture = readWith(kIntrinsics, frame("images/b.jpg") + "," + frame("./images/a.jpg"));
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->views.size(), 2u);
  EXPECT_EQ(capture->views[0].view.name, "images/a.jpg");
  EXPECT_EQ(capture->views[0].photo, folder_ / "images/a.jpg");
  const View& view = capture->views[1].view;
  EXPECT_THAT(view.worldFromCamera, ElementsAre(1, 0, 0, 4, 0, -1, 0, 5, 0, 0, -1, 6));
  EXPECT_EQ(view.height, 480u);
  EXPECT_EQ(view.fy, 510);
  EXPECT_EQ(view.cx, 322);
  EXPECT_EQ(view.lens.kind, LensKind::kPinhole);
}

TEST_F(TransformsTest, FramesOverrideAndLensesAreNamed) {
  const std::string fisheye = frame("b.jpg", R"(, "fl_x": 700, "is_fisheye": true, "k1": 0.5, "k4": 0.25)");
  const Result<Capture> capture = readWith(
      std::string(kIntrinsics) + R"(, "k1": 0.1, "k2": -0.2, "p1": 0.01, "p2": 0.02)", frame("a.jpg") + "," + fisheye);
  ASSERT_TRUE(capture) << capture.error().message;
  const View &first = capture->views[0].view, &second = capture->views[1].view;
  EXPECT_EQ(first.lens.kind, LensKind::kRadialTangential);
  EXPECT_THAT(first.lens.distortion, ElementsAre(0.1, -0.2, 0.01, 0.02, 0));
  EXPECT_EQ(first.fx, 500);
  EXPECT_EQ(second.fx, 700);
  EXPECT_EQ(second.lens.kind, LensKind::kKannalaBrandt);
  EXPECT_THAT(second.lens.distortion, ElementsAre(0.5, -0.2, 0, 0.25));
}

TEST_F(TransformsTest, SizesAndExtensionsThatAreLeftOutComeFromThePhotos) {
  writePhoto("train/r_0.png", 80, 60);
  const Result<Capture> capture = readWith("\"camera_angle_x\": 1.5707963267948966", frame("./train/r_0"));
  ASSERT_TRUE(capture) << capture.error().message;
  const View& view = capture->views[0].view;
  EXPECT_EQ(view.name, "train/r_0.png");
  EXPECT_EQ(view.width, 80u);
  EXPECT_NEAR(view.fx, 40, 1e-12);  // a right angle
  EXPECT_NEAR(view.fy, 40, 1e-12);
  EXPECT_EQ(view.cy, 30);
  expectBad("\"camera_angle_x\": 1.5", frame("absent"), {"absent.png"});
}

TEST_F(TransformsTest, PartsAreTakenFromFilesOrLists) {
  const std::string head = std::string("{") + kIntrinsics + ", \"frames\": [";
  write("transforms_train.json", head + frame("train/0.png") + "]}");
  write("transforms_val.json", head + frame("val/0.png") + "]}");
  Result<Capture> capture = readCapture(folder_);
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->views.size(), 2u);
  EXPECT_EQ(capture->views[0].part, CapturePart::kTraining);
  EXPECT_EQ(capture->views[1].part, CapturePart::kTest);
  write("transforms_test.json", head + frame("test/0.png") + "," + frame("test/1.png") + "]}");
  capture = readCapture(folder_);
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->views.size(), 3u);
  EXPECT_EQ(capture->views[0].view.name, "test/0.png");
  EXPECT_EQ(capture->views[0].part, CapturePart::kTest);

  capture = readWith(std::string(kIntrinsics) + R"(, "train_filenames": ["a.png"], "val_filenames": ["c.png"])",
                     frame("a.png") + "," + frame("b.png") + "," + frame("c.png"));
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->views[0].part, CapturePart::kTraining);
  EXPECT_EQ(capture->views[1].part, CapturePart::kUnsaid);
  EXPECT_EQ(capture->views[2].part, CapturePart::kTest);
}

TEST_F(TransformsTest, MasksAreFoundByTheNamesOfPhotos) {
  writePhoto("masks/a.png", 8, 8);
  writePhoto("masks/b.jpg.png", 8, 8);
  writePhoto("images/dynamic_mask_c.png", 8, 8);
  const Result<Capture> capture =
      readWith(kIntrinsics, frame("images/a.jpg") + "," + frame("images/b.jpg") + "," + frame("images/c.jpg") + "," +
                                frame("images/d.jpg") + "," + frame("images/e.jpg", R"(, "mask_path": "m/e.png")"));
  ASSERT_TRUE(capture) << capture.error().message;
  const std::vector<CapturedView>& views = capture->views;
  EXPECT_EQ(views[0].mask, folder_ / "masks/a.png");
  EXPECT_EQ(views[1].mask, folder_ / "masks/b.jpg.png");
  EXPECT_EQ(views[2].mask, folder_ / "images/dynamic_mask_c.png");
  EXPECT_EQ(views[2].maskSense, MaskSense::kWhiteIgnored);
  EXPECT_EQ(views[3].mask, "");
  EXPECT_EQ(views[4].mask, folder_ / "m/e.png");
}

TEST_F(TransformsTest, FaultsAreNamed) {
  const std::string intrinsics = kIntrinsics;
  expectBad(intrinsics, "", {"transforms.json", "'frames'", "no frame"});
  expectBad(intrinsics, frame("a.jpg") + "," + frame("./a.jpg"), {"'file_path'", "'a.jpg' in two frames"});
  expectBad(intrinsics, frame("a.jpg") + ", 7", {"frame 1", "give an object"});
  expectBad(intrinsics, R"({"file_path": "a.jpg"})", {"frame 0", "'transform_matrix': found nothing"});
  expectBad(intrinsics, R"({"file_path": "a.jpg", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,null]]})",
            {"frame 0", "row 2, column 3"});
  expectBad(intrinsics, R"({"file_path": "a.jpg", "transform_matrix": [[2,0,0,0],[0,1,0,0],[0,0,1,0]]})",
            {"frame 0", "orthonormal"});
  expectBad(intrinsics, frame("../../etc/passwd"), {"frame 0, field 'file_path'", "below the folder"});
  expectBad(intrinsics, frame("a.jpg", R"(, "mask_path": "/etc/passwd")"), {"'mask_path'"});
  expectBad("\"w\": 640, \"h\": 480", frame("a.jpg"), {"'fl_x': found nothing", "camera_angle_x"});
  expectBad("\"w\": 640, \"h\": 480, \"fl_x\": 0", frame("a.jpg"), {"'fx'", "found 0"});
  expectBad("\"w\": 640.5, \"h\": 480, \"fl_x\": 9", frame("a.jpg"), {"'w': found 640.5"});
  expectBad("\"w\": 640, \"h\": 480, \"camera_angle_x\": 4", frame("a.jpg"), {"'camera_angle_x': found 4"});
  expectBad(intrinsics + ", \"camera_model\": \"EQUIRECTANGULAR\"", frame("a.jpg"), {"'camera_model'"});
  expectBad(intrinsics + ", \"k4\": 0.5", frame("a.jpg"), {"'k4': found 0.5"});
  write("transforms.json", "{");
  EXPECT_FALSE(readCapture(folder_));
  fs::remove(folder_ / "transforms.json");
  write("points.ply", "ply\n");
  const Result<Capture> points = readCapture(folder_ / "points.ply");
  ASSERT_FALSE(points);
  EXPECT_THAT(points.error().message, HasSubstr("no transforms.json; give the scene's folder"));
  const Result<Capture> none = readCapture(folder_);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("neither a COLMAP model nor transforms.json"));
}

TEST_F(TransformsTest, ReadViewsTellsItFromCamerasJson) {
  ASSERT_TRUE(readWith(kIntrinsics, frame("a.jpg")));
  for (const fs::path& path : {folder_, folder_ / "transforms.json"}) {
    const Result<CameraSet> cameras = readViews(path);
    ASSERT_TRUE(cameras) << cameras.error().message;
    EXPECT_EQ(cameras->views[0].name, "a.jpg");
  }
  ASSERT_TRUE(writeCameras(folder_ / "cameras.json", *readViews(folder_)));
  const Result<CameraSet> cameras = readViews(folder_ / "cameras.json");
  ASSERT_TRUE(cameras) << cameras.error().message;
  EXPECT_EQ(cameras->views[0].fy, 510);
  EXPECT_FALSE(readViews(folder_ / "absent.json"));
}

}  // namespace
}  // namespace froth
