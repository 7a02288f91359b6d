// What froth report tells of levels of detail.
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include <gmock/gmock.h>

#include "reference/camera/camera.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

// Of a gallery, measured once.
class ReportLevels : public ToolTest {
 protected:
  void measureGallery() const {
    if (!figures_.is_null()) return;
    frothWell({"synth", "gallery", "--cells", "6000", "-o", "gallery.pt"});
    frothWell({"bake", "gallery.pt", "--lod", "--chunk-cells", "512", "--no-measure", "-o", "gallery.froth"});
    stepBack(25);
    frothWell({"report", "gallery.froth", "--cameras", "outside.json", "-o", "out", "--size", "96x64", "--views", "1",
               "--search", "0s", "--frames", "1", "--knobs", "detail,budget", "--no-images"});
    figures_ = Json::parse(readBytes(folder_ / "out/report.json"));
    page_ = readBytes(folder_ / "out/report.html");
  }
  // From within the balls of groups all of them are fine at any detail: outside.json looks at the gallery from outside.
  void stepBack(double distance) const {
    CameraSet cameras = *readCameras(folder_ / "gallery.cameras.json");
    cameras.views.resize(1);
    std::array<double, 12>& pose = cameras.views[0].worldFromCamera;
    for (size_t row = 0; row < 12; row += 4) pose[row + 3] -= distance * pose[row + 2];
    ASSERT_TRUE(writeCameras(folder_ / "outside.json", cameras));
  }
  static void TearDownTestSuite() {
    figures_ = {};
    page_.clear();
  }

  // JSON has no infinity.
  static double number(const Json& value) { return value == "inf" ? INFINITY : value.get<double>(); }

  static inline Json figures_;
  static inline std::string page_;
};

TEST_F(ReportLevels, ErrorsFallAndBytesGrowWithDetailAndBudget) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  measureGallery();
  const Json& figures = figures_;
  std::map<std::string, Json> points;
  for (const Json& point : figures["points"]) points[point["id"]] = point;
  const Json& whole = points.at("raster detail=all cells");
  EXPECT_EQ(whole["wholeErrors"]["psnr"], "inf") << "it is what others are compared with";
  EXPECT_EQ(whole["wholeErrors"]["maxError"], 0);
  EXPECT_GT(whole["viewBytes"], 0);
  for (const Json& sweep : figures["sweeps"]) {
    uint64_t bytes = 0;
    for (const Json& id : sweep["points"]) {
      EXPECT_GE(points.at(id)["drawnBytes"].get<uint64_t>(), bytes) << id;
      bytes = points.at(id)["drawnBytes"];
    }
    const Json &least = points.at(sweep["points"].front()), &most = points.at(sweep["points"].back());
    EXPECT_LT(least["drawnBytes"], whole["drawnBytes"]);
    EXPECT_LT(least["drawnCells"], whole["drawnCells"]);
    const double gained = number(most["wholeErrors"]["psnr"]) - number(least["wholeErrors"]["psnr"]);
    EXPECT_GT(gained, 0) << sweep["knob"];
  }
  EXPECT_EQ(figures["sweeps"].size(), 2u);
}

TEST_F(ReportLevels, NamesTheLeastBytesThatEachErrorNeeds) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  measureGallery();
  const Json& figures = figures_;
  ASSERT_EQ(figures["levelNeeds"].size(), 3u);
  for (const Json& need : figures["levelNeeds"]) {
    Json chosen;
    for (const Json& point : figures["points"]) {
      if (point["id"] == need["point"]) chosen = point;
    }
    ASSERT_FALSE(chosen.is_null()) << "all cells are good enough for any";
    EXPECT_GE(number(chosen["wholeErrors"]["psnr"]), need["psnr"].get<double>());
    for (const Json& point : figures["points"]) {
      if (number(point["wholeErrors"]["psnr"]) < need["psnr"].get<double>()) continue;
      EXPECT_LE(chosen["drawnBytes"], point["drawnBytes"]) << point["id"];
    }
  }
  EXPECT_THAT(page_, HasSubstr("What these views need"));
  EXPECT_THAT(page_, HasSubstr("Error over bytes"));
}

TEST_F(ReportLevels, AreNoneOfAnAssetWithoutThem) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("40");
  frothWell({"report", "random.froth", "--cameras", "cameras.json", "-o", "out", "--size", "48x32", "--search", "0s",
             "--frames", "1", "--knobs", "layers", "--no-images"});
  const Json figures = Json::parse(readBytes(folder_ / "out/report.json"));
  EXPECT_TRUE(figures["levelNeeds"].empty());
  EXPECT_FALSE(figures["points"][0].contains("wholeErrors"));
  EXPECT_EQ(readBytes(folder_ / "out/report.html").find("What these views need"), std::string::npos);
}

}  // namespace
}  // namespace froth::test
