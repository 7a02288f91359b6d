// A folder with photos of a small foam, for tests that train.
#pragma once

#include <string>
#include <vector>

#include "tests/tool/program_runner.h"

namespace froth::test {

class ShotsTest : public ToolTest {
 protected:
  static constexpr size_t kPhotos = 6;

  // Photos of the foam "random" under shots/, with transforms.json.
  void makeShots() const {
    makeRandomFoam("60", kPhotos);
    Result<CameraSet> cameras = readCameras(folder_ / "cameras.json");
    ASSERT_TRUE(cameras);
    for (size_t i = 0; i < kPhotos; ++i) cameras->views[i].name = "shot_" + std::to_string(i);
    ASSERT_TRUE(writeCameras(folder_ / "cameras.json", *cameras));
    std::filesystem::create_directory(folder_ / "shots");
    for (size_t i = 0; i < kPhotos; ++i) {
      frothWell({"render", "random.pt", "--cameras", "cameras.json", "--renderer", "reference", "--size", "32x32",
                 "--view", std::to_string(i), "-o", "shots/" + cameras->views[i].name + ".png"});
    }
    nlohmann::json frames = nlohmann::json::array();
    for (const View& view : cameras->views) {
      nlohmann::json matrix = nlohmann::json::array();
      for (size_t row = 0; row < 3; ++row) {
        const double* m = &view.worldFromCamera[4 * row];
        matrix.push_back({m[0], -m[1], -m[2], m[3]});  // axes right, up, back
      }
      matrix.push_back({0, 0, 0, 1});
      frames.push_back({{"file_path", view.name + ".png"}, {"transform_matrix", matrix}});
    }
    const View view = resizeView(cameras->views.front(), 32, 32);
    writeBytes(folder_ / "shots/transforms.json",
               nlohmann::json{{"fl_x", view.fx}, {"fl_y", view.fy}, {"w", 32}, {"h", 32}, {"frames", frames}}.dump());
  }

  // Of those photos, on the CPU, in half a second.
  static std::vector<std::string> trainCommand() {
    return {"train", "shots",   "-o", "trained.pt",     "--cells", "200",      "--steps",
            "30",    "--lobes", "1",  "--detail-sites", "1",       "--device", "cpu"};
  }
};

}  // namespace froth::test
