// Commands take a capture wherever they take cameras.json.
#include <gmock/gmock.h>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "base/image/image.h"
#include "tests/tool/program_runner.h"

namespace froth {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CaptureCommands : public test::ToolTest {
 protected:
  // cameras.json, transforms.json and colmap/sparse/0 of one view; its photo is not there.
  CaptureCommands() {
    makeRandomFoam("40");
    const View view = readCameras(folder_ / "cameras.json")->views[0];
    const auto& m = view.worldFromCamera;
    std::string rows;
    for (int row = 0; row < 3; ++row) {
      rows += fmt::format("[{}, {}, {}, {}], ", m[4 * row], -m[4 * row + 1], -m[4 * row + 2], m[4 * row + 3]);
    }
    test::writeBytes(folder_ / "transforms.json",
                     fmt::format(R"({{"w": {}, "h": {}, "fl_x": {}, "fl_y": {}, "cx": {}, "cy": {}, "frames": )"
                                 R"([{{"file_path": "a.jpg", "transform_matrix": [{} [0, 0, 0, 1]]}}]}})",
                                 view.width, view.height, view.fx, view.fy, view.cx, view.cy, rows));
    const fs::path model = folder_ / "colmap" / "sparse" / "0";
    fs::create_directories(model);
    const glm::dmat3 cameraFromWorld(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    const glm::dquat q = glm::quat_cast(cameraFromWorld);
    const glm::dvec3 t = -(cameraFromWorld * glm::dvec3(m[3], m[7], m[11]));
    test::writeBytes(model / "cameras.txt", fmt::format("1 PINHOLE {} {} {} {} {} {}\n", view.width, view.height,
                                                        view.fx, view.fy, view.cx, view.cy));
    test::writeBytes(model / "images.txt",
                     fmt::format("1 {} {} {} {} {} {} {} 1 a.jpg\n\n", q.w, q.x, q.y, q.z, t.x, t.y, t.z));
    test::writeBytes(model / "points3D.txt", "");
  }

  Image render(const std::string& cameras) const {
    frothWell(
        {"render", "random.froth", "--cameras", cameras, "--renderer", "reference", "--view", "0", "-o", "image.pfm"});
    return *readImage(folder_ / "image.pfm");
  }
};

TEST_F(CaptureCommands, RenderDrawsTheSameFromAnyOfThem) {
  const Image expected = render("cameras.json");
  EXPECT_EQ(render("transforms.json").values, expected.values);
  const Image colmap = render("colmap");  // its rotation went through a quaternion
  ASSERT_EQ(colmap.values.size(), expected.values.size());
  for (size_t i = 0; i < expected.values.size(); ++i) ASSERT_NEAR(colmap.values[i], expected.values[i], 1e-6) << i;
}

TEST_F(CaptureCommands, BakeStoresTheirFirstViewAsTheStart) {
  for (const char* cameras : {"cameras.json", "transforms.json", "colmap"}) {
    frothWell({"bake", "random.pt", "-o", "baked.froth", "--cameras", cameras, "--no-measure"});
    EXPECT_GT(fs::file_size(folder_ / "baked.froth"), 0u) << cameras;
  }
}

TEST_F(CaptureCommands, FoldersWithoutACaptureAreRefused) {
  fs::create_directories(folder_ / "empty");
  const test::ProgramRun run =
      froth({"render", "random.froth", "--cameras", "empty", "--renderer", "reference", "-o", "out"});
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_THAT(run.err, HasSubstr("neither a COLMAP model nor transforms.json"));
}

}  // namespace
}  // namespace froth
