// From a synthetic foam to measured pictures, through the program.
#include <limits>

#include "reference/camera/ray_map.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

class EndToEnd : public ToolTest {
 protected:
  std::string render(const std::string& input, const std::string& renderer, const std::string& output,
                     std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"render", input,   "--cameras", "cameras.json", "--view",     "0",
                                       "--size", "96x64", "-o",        output,         "--renderer", renderer};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return frothWell(arguments);
  }
  double psnr(const std::string& a, const std::string& b) const {
    const nlohmann::json difference = frothJson({"compare", a, b});
    return difference["psnr"].is_null() ? std::numeric_limits<double>::infinity() : difference["psnr"].get<double>();
  }
};

TEST_F(EndToEnd, ABakedFoamIsVerifiedAndDescribed) {
  makeRandomFoam("300");
  frothWell({"verify", "random.froth"});
  const nlohmann::json asset = frothJson({"info", "random.froth"});
  EXPECT_EQ(asset["kind"], "asset");
  EXPECT_EQ(asset["inputCells"], 300);
  EXPECT_EQ(asset["cells"].get<int>() + asset["hiddenDropped"].get<int>() - asset["steinerCells"].get<int>(), 300);
  EXPECT_EQ(asset["bytes"], std::filesystem::file_size(folder_ / "random.froth"));
  EXPECT_EQ(asset["nearRatio"], 4.0);
  const nlohmann::json checkpoint = frothJson({"info", "random.pt"});
  EXPECT_EQ(checkpoint["kind"], "checkpoint");
  EXPECT_EQ(checkpoint["cells"], 300);
}

TEST_F(EndToEnd, ABakeReportsItsStagesAndKeepsCamerasAndNearLimits) {
  makeRandomFoam("100", 2);
  const nlohmann::json bake = frothJson({"bake", "random.pt", "--preset", "exact", "-o", "b.froth", "--near-ratio", "2",
                                         "--near-depth", "0.5", "--cameras", "cameras.json"});
  EXPECT_GE(bake["stages"].size(), 4u);
  EXPECT_EQ(bake["stages"].front()["stage"], "import");
  EXPECT_GT(bake["stages"].back()["peakBytes"], 0);
  const nlohmann::json info = frothJson({"info", "b.froth"});
  EXPECT_EQ(info["nearRatio"], 2.0);
  EXPECT_EQ(info["nearDepth"], 0.5);
  EXPECT_EQ(info["hasStartView"], true);
}

TEST_F(EndToEnd, FiguresGoToAFileBesideTheTable) {
  makeRandomFoam("60");
  const std::string table = frothWell({"info", "random.froth", "--json=figures.json"});
  EXPECT_NE(table.find("cells"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder_ / "figures.json"))["kind"], "asset");
}

TEST_F(EndToEnd, TheSameFoamBakesToTheSameBytes) {
  makeRandomFoam("300");
  frothWell({"synth", "random", "--cells", "300", "-o", "again.pt"});
  EXPECT_EQ(readBytes(folder_ / "random.pt"), readBytes(folder_ / "again.pt"));
  frothWell({"bake", "random.pt", "--preset", "exact", "-o", "again.froth"});
  EXPECT_EQ(readBytes(folder_ / "random.froth"), readBytes(folder_ / "again.froth"));
  frothWell({"synth", "random", "--cells", "300", "--seed", "2", "-o", "other.pt"});
  EXPECT_NE(readBytes(folder_ / "random.pt"), readBytes(folder_ / "other.pt"));
}

TEST_F(EndToEnd, ReferenceDrawsCheckpointAndAssetAlike) {
  makeRandomFoam("300");
  render("random.pt", "reference", "checkpoint.pfm");
  render("random.froth", "reference", "asset.pfm");
  EXPECT_GE(psnr("checkpoint.pfm", "asset.pfm"), 100);
  render("random.pt", "reference", "float.pfm", {"--precision", "float"});
  EXPECT_GE(psnr("checkpoint.pfm", "float.pfm"), 60);
}

TEST_F(EndToEnd, RasterAndWalkDrawWhatTheReferenceDraws) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("300");
  for (const std::string channel : {"colour", "alpha", "normal"}) {
    render("random.froth", "reference", "reference.pfm", {"--channel", channel});
    for (const std::string renderer : {"raster", "walk"}) {
      render("random.froth", renderer, "drawn.pfm", {"--channel", channel, "--validate", "--cutoff", "0"});
      EXPECT_GE(psnr("reference.pfm", "drawn.pfm"), 60) << renderer << " " << channel;
    }
  }
}

// A fisheye, a panorama, parallel rays and a ray map, each beside the other in one cameras.json.
TEST_F(EndToEnd, AllRenderersDrawThroughAllLenses) {
  if (!hasDevice()) FROTH_SKIP() << "no Vulkan device";
  makeRandomFoam("300");
  const View pinhole = viewOfRandomFoam(96, 64);
  CameraSet cameras;
  const auto add = [&](LensKind kind, double pixelsPerUnit) -> View& {
    View& view = cameras.views.emplace_back(pinhole);
    view.lens.kind = kind;
    view.fx = view.fy = pixelsPerUnit;
    return view;
  };
  add(LensKind::kFisheye, 80);
  add(LensKind::kEquirectangular, 20);
  add(LensKind::kOrthographic, 20);
  RayMap map{96, 64, {}};
  for (uint32_t i = 0; i < 96 * 64; ++i) {
    map.directions.push_back(
        {(i % 96 / 96.0f - 0.5f) * 0.8f, (i / 96 / 64.0f - 0.5f) * 0.6f, i % 7 == 0 ? 0.9f : 1.0f});
  }
  ASSERT_TRUE(writeRayMap(folder_ / "rays.f32", map));
  add(LensKind::kRayMap, 1).lens.raysFile = "rays.f32";
  ASSERT_TRUE(writeCameras(folder_ / "cameras.json", cameras));

  for (const std::string renderer : {"reference", "raster", "walk"}) {
    frothWell({"render", "random.froth", "--cameras", "cameras.json", "-o", renderer, "--renderer", renderer});
  }
  for (const std::string view : {"view_00.pfm", "view_01.pfm", "view_02.pfm", "view_03.pfm"}) {
    EXPECT_GE(psnr("reference/" + view, "raster/" + view), 55) << view;
    EXPECT_GE(psnr("raster/" + view, "walk/" + view), 60) << view;
  }
}

TEST_F(EndToEnd, ACheckpointIsBakedInMemoryForTheDevice) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("60");
  render("random.pt", "raster", "checkpoint.pfm");
  render("random.froth", "raster", "asset.pfm");
  EXPECT_EQ(readBytes(folder_ / "checkpoint.pfm"), readBytes(folder_ / "asset.pfm"));
}

TEST_F(EndToEnd, LinearColourOfRuntimeAndReferenceAgree) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("60");
  render("random.froth", "reference", "reference.pfm", {"--linear"});
  render("random.froth", "raster", "raster.pfm", {"--linear"});
  EXPECT_GE(psnr("reference.pfm", "raster.pfm"), 60);
}

TEST_F(EndToEnd, AnImageBeyondWhatDevicesAllowIsRefused) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("12");
  const ProgramRun run = froth({"render", "random.froth", "--cameras", "cameras.json", "--view", "0", "--size",
                                "16384x16384", "--renderer", "raster", "-o", "a.pfm"});
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_NE(run.err.find("16384 x 16384"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.pfm"));
}

TEST_F(EndToEnd, DepthThatIsNeverReachedIsMinusOne) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("60");
  render("random.froth", "reference", "reference.pfm", {"--channel", "depth"});
  render("random.froth", "raster", "raster.pfm", {"--channel", "depth"});
  const nlohmann::json difference = frothJson({"compare", "reference.pfm", "raster.pfm"});
  EXPECT_LE(difference["overOneStep"], 0.002);  // rays that graze the quantile fall either way
}

TEST_F(EndToEnd, AllViewsGoIntoAFolder) {
  makeRandomFoam("60", 3);
  frothWell({"render", "random.froth", "--cameras", "cameras.json", "--renderer", "reference", "--size", "24x16", "-o",
             "out"});
  for (const char* name : {"view_00.pfm", "view_01.pfm", "view_02.pfm"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
  }
}

TEST_F(EndToEnd, ATilingOfAnAssetIsAnAsset) {
  makeRandomFoam("60");
  frothWell({"synth", "tile", "--of", "random.froth", "--count", "3", "-o", "tiled.froth"});
  frothWell({"verify", "tiled.froth"});
  const nlohmann::json once = frothJson({"info", "random.froth"}), thrice = frothJson({"info", "tiled.froth"});
  EXPECT_EQ(thrice["inputCells"].get<int>(), 3 * once["cells"].get<int>());
}

TEST_F(EndToEnd, TheGalleryComesWithCamerasAndGroundTruth) {
  frothWell({"synth", "gallery", "--cells", "8000", "-o", "gallery.pt"});
  ASSERT_TRUE(std::filesystem::exists(folder_ / "gallery.cameras.json"));
  frothWell({"synth", "gallery", "--ground-truth", "gallery.cameras.json", "--samples", "1", "--size", "48x32",
             "--view", "1", "-o", "traced.pfm"});
  frothWell({"render", "gallery.pt", "--cameras", "gallery.cameras.json", "--renderer", "reference", "--size", "48x32",
             "--view", "1", "-o", "foam.pfm"});
  EXPECT_GE(psnr("traced.pfm", "foam.pfm"), 12);  // so few cells show the room coarsely, but the same room
}

TEST_F(EndToEnd, BenchTimesEveryPass) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("60", 2);
  for (const std::string renderer : {"raster", "walk"}) {
    const nlohmann::json bench = frothJson({"bench", "random.froth", "--cameras", "cameras.json", "--size", "32x32",
                                            "--frames", "100", "--warmup", "0s", "--renderer", renderer});
    EXPECT_EQ(bench["frames"], 100);
    EXPECT_EQ(bench["views"].size(), 2u);
    EXPECT_GT(bench["passes"].size(), 1u);
    double sum = 0;
    for (const auto& [name, times] : bench["passes"].items()) {
      EXPECT_LE(times["p5"], times["median"]) << name;
      EXPECT_LE(times["median"], times["p95"]) << name;
      sum += times["median"].get<double>();
    }
    EXPECT_GT(sum, 0);
    EXPECT_GT(bench["total"]["median"], 0);
  }
}

}  // namespace
}  // namespace froth::test
