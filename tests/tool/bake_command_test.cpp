// froth bake: presets, knobs, layers, reports; and bytes that depend on nothing but input and options.
#include <algorithm>
#include <filesystem>
#include <limits>

#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

class BakeCommand : public ToolTest {
 protected:
  nlohmann::json bake(const std::string& output, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"bake", "random.pt", "-o", output, "--cameras", "cameras.json"};
    if (std::ranges::count(more, "--preset") == 0) arguments.insert(arguments.end(), {"--preset", "exact"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return frothJson(arguments);
  }
  void render(const std::string& input, const std::string& output, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"render",     input,       "--cameras", "cameras.json", "--view",      "0",
                                       "--renderer", "reference", "-o",        output,         "--precision", "float"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    frothWell(arguments);
  }
  double psnr(const std::string& a, const std::string& b) const {
    const nlohmann::json difference = frothJson({"compare", a, b});
    return difference["psnr"].is_null() ? std::numeric_limits<double>::infinity() : difference["psnr"].get<double>();
  }
  std::string bytesOf(const std::string& name) const { return readBytes(folder_ / name); }
};

TEST_F(BakeCommand, PresetsTradeBytesForQuality) {
  makeRandomFoam("200");
  const nlohmann::json exact = bake("exact.froth");
  EXPECT_TRUE(exact["statistics"]["psnr"].is_null());
  render("exact.froth", "exact.pfm");
  double bytes = exact["bytes"], quality = 200;
  for (const std::string preset : {"high", "default", "small"}) {
    const nlohmann::json baked = bake(preset + ".froth", {"--preset", preset});
    frothWell({"verify", preset + ".froth"});
    render(preset + ".froth", preset + ".pfm");
    const double found = psnr("exact.pfm", preset + ".pfm");
    EXPECT_LT(baked["bytes"], bytes) << preset;
    EXPECT_LT(found, quality) << preset;
    EXPECT_GT(found, 25) << preset;
    EXPECT_NEAR(baked["statistics"]["psnr"].get<double>(), found, 1.5) << preset;  // measured on this view, at its size
    bytes = baked["bytes"];
    quality = found;
  }
}

TEST_F(BakeCommand, SaysForWhichEyesAnAssetIsGood) {
  makeRandomFoam("100");
  bake("near.froth", {"--preset", "default", "--eyes", "cameras+0.25"});
  const nlohmann::json near = frothJson({"info", "near.froth"})["eyes"];
  EXPECT_EQ(near["boxes"].size(), 1u);
  EXPECT_EQ(near["radius"], 0.25);
  EXPECT_GT(near["worstPsnr"], 10);
  EXPECT_NE(frothWell({"info", "near.froth"}).find("eyes              within 0.25 of those of 1 cameras"),
            std::string::npos);
  bake("box.froth", {"--preset", "default", "--eyes", "box:-1,-2,-3,1,2,3.5", "--no-measure"});
  const nlohmann::json box = frothJson({"info", "box.froth"})["eyes"];
  EXPECT_EQ(box["boxes"][0]["max"], nlohmann::json::parse("[1, 2, 3.5]"));
  EXPECT_TRUE(box["worstPsnr"].is_null());
  bake("exact.froth");
  EXPECT_TRUE(frothJson({"info", "exact.froth"})["eyes"].is_null());
}

TEST_F(BakeCommand, NeedsCamerasForEyesAroundThem) {
  makeRandomFoam("100");
  const ProgramRun run = froth({"bake", "random.pt", "-o", "b.froth", "--eyes", "cameras+1"});
  EXPECT_NE(run.exitCode, 0);
  EXPECT_NE(run.err.find("give cameras with views, or a box"), std::string::npos) << run.err;
}

TEST_F(BakeCommand, WithoutAPresetMakesTheDefaultOne) {
  makeRandomFoam("100");
  frothWell({"bake", "random.pt", "-o", "b.froth"});
  EXPECT_EQ(frothJson({"info", "b.froth"})["preset"], "default");
}

TEST_F(BakeCommand, BakesAllCheckpointsOfAFolderWithTheirCameras) {
  namespace fs = std::filesystem;
  makeRandomFoam("100");
  fs::create_directories(folder_ / "foams" / "inner");
  fs::copy_file(folder_ / "random.pt", folder_ / "foams" / "a.pt");
  fs::copy_file(folder_ / "random.pt", folder_ / "foams" / "b.pt");
  fs::copy_file(folder_ / "cameras.json", folder_ / "foams" / "b.cameras.json");
  fs::copy_file(folder_ / "random.pt", folder_ / "foams" / "inner" / "model.pt");
  fs::copy_file(folder_ / "cameras.json", folder_ / "foams" / "inner" / "cameras.json");
  const nlohmann::json bakes = frothJson({"bake", "foams", "-o", "assets", "--no-measure"});
  ASSERT_EQ(bakes.size(), 3u);
  EXPECT_EQ(bakes[0]["output"], "assets/a.froth");
  EXPECT_EQ(bakes[1]["output"], "assets/b.froth");
  EXPECT_EQ(bakes[2]["output"], "assets/inner.froth");
  EXPECT_EQ(frothJson({"info", "assets/a.froth"})["hasStartView"], false);
  EXPECT_EQ(frothJson({"info", "assets/b.froth"})["hasStartView"], true);
  frothWell({"bake", "random.pt", "-o", "one.froth", "--cameras", "cameras.json", "--no-measure"});
  EXPECT_EQ(bytesOf("assets/b.froth").size(), bytesOf("one.froth").size());  // they name their sources
}

// One that cannot be baked stops none of the others, and is told at the end.
TEST_F(BakeCommand, GoesOnBehindACheckpointOfAFolderThatIsBad) {
  namespace fs = std::filesystem;
  makeRandomFoam("100");
  fs::create_directories(folder_ / "foams");
  writeBytes(folder_ / "foams" / "a.pt", "no checkpoint");
  fs::copy_file(folder_ / "random.pt", folder_ / "foams" / "b.pt");
  const ProgramRun run = froth({"bake", "foams", "-o", "assets", "--no-measure"});
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_NE(run.err.find("foams/a.pt"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("1 of 2"), std::string::npos) << run.err;
  EXPECT_TRUE(fs::exists(folder_ / "assets" / "b.froth"));
  fs::create_directories(folder_ / "empty");
  EXPECT_NE(froth({"bake", "empty", "-o", "assets"}).err.find("holds no checkpoint"), std::string::npos);
}

TEST_F(BakeCommand, KeepsTheRightsOfTheAssetThatItReplaces) {
  namespace fs = std::filesystem;
  makeRandomFoam("12");
  bake("new.froth");
  writeBytes(folder_ / "old.froth", "old");
  fs::permissions(folder_ / "old.froth", fs::perms(0600));
  fs::create_symlink("old.froth", folder_ / "link.froth");
  bake("link.froth");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.froth"));
  EXPECT_EQ(bytesOf("old.froth"), bytesOf("new.froth"));
  EXPECT_EQ(fs::status(folder_ / "old.froth").permissions(), fs::perms(0600));

  writeBytes(folder_ / "old.froth", "old");
  fs::permissions(folder_ / "old.froth", fs::perms(0444));
  const ProgramRun refused = froth({"bake", "random.pt", "-o", "old.froth"});
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE(refused.err.find("old.froth: is write-protected"), std::string::npos) << refused.err;
  EXPECT_EQ(bytesOf("old.froth"), "old");
  bake("old.froth", {"--force"});
  EXPECT_EQ(bytesOf("old.froth"), bytesOf("new.froth"));
  EXPECT_EQ(fs::status(folder_ / "old.froth").permissions(), fs::perms(0444));
}

TEST_F(BakeCommand, AKnobChangesItsLatticeAndNothingElse) {
  makeRandomFoam("60");
  bake("b.froth", {"--position-bits", "12", "--radius-bits", "7", "--frame-bits", "9", "--height-bits", "3"});
  const nlohmann::json info = frothJson({"info", "b.froth"});
  EXPECT_GT(info["positionStep"], 0);
  EXPECT_EQ(info["radiusBits"], 7);
  EXPECT_EQ(info["normalBits"], 9);
  EXPECT_EQ(info["heightStep"], 0.125);
  EXPECT_EQ(info["detailSiteStep"], 0);
  EXPECT_EQ(info["colourStep"], 0);
  EXPECT_LE(info["errors"]["radii"]["max"], 1.0 / 256);
  EXPECT_GT(info["errors"]["radii"]["rms"], 0);
  EXPECT_EQ(info["errors"]["densities"]["max"], 0);
}

TEST_F(BakeCommand, InfoTellsTheMemoryOfTheAssetAndOfAView) {
  makeRandomFoam("60");
  bake("b.froth", {});
  EXPECT_FALSE(frothJson({"info", "b.froth"}).contains("memory"));
  const nlohmann::json memory = frothJson({"info", "b.froth", "--memory"})["memory"];
  EXPECT_GT(memory["assetBytes"], 60 * 16);  // sites and radii alone
  EXPECT_EQ(memory["viewExtent"], (std::vector<int>{1920, 1080}));
  EXPECT_GT(memory["viewBytes"], 60 * 175);
  const std::string line = std::to_string(memory["assetBytes"].get<uint64_t>()) + " bytes of the asset, " +
                           std::to_string(memory["viewBytes"].get<uint64_t>()) + " of a view of 1920 x 1080 pixels\n";
  EXPECT_NE(frothWell({"info", "b.froth", "--memory"}).find(line), std::string::npos);
}

TEST_F(BakeCommand, BytesAreTheSameOnAnyNumberOfThreads) {
  makeRandomFoam("400");
  for (const std::string preset : {"exact", "default"}) {
    const std::vector<std::string> options{"--preset", preset, "--chunk-cells", "90", "--no-measure"};
    const auto bakeWith = [&](const std::string& output, const std::string& flag, const std::string& value) {
      std::vector<std::string> all = options;
      all.insert(all.end(), {flag, value});
      bake(output, all);
      return bytesOf(output);
    };
    const std::string one = bakeWith("a.froth", "--threads", "1");
    EXPECT_EQ(one, bakeWith("b.froth", "--threads", "2"));
    EXPECT_EQ(one, bakeWith("b.froth", "--threads", "8"));
  }
}

TEST_F(BakeCommand, BytesAreThoseOfTheSeed) {
  makeRandomFoam("100");
  const auto bakeWith = [&](const std::string& seed) {
    bake("seeded.froth", {"--preset", "default", "--no-measure", "--seed", seed});
    return bytesOf("seeded.froth");
  };
  const std::string first = bakeWith("1");
  EXPECT_EQ(first, bakeWith("1"));
  EXPECT_NE(first, bakeWith("2"));
}

TEST_F(BakeCommand, BytesAreTheSameWithAMemoryLimitAndOneTooLowIsRefused) {
  makeRandomFoam("3000");
  bake("a.froth");
  bake("b.froth", {"--memory-limit", "2MB"});
  EXPECT_EQ(bytesOf("a.froth"), bytesOf("b.froth"));
  const ProgramRun refused = froth({"bake", "random.pt", "-o", "c.froth", "--memory-limit", "64KB"});
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_NE(refused.err.find("raise the limit"), std::string::npos) << refused.err;
}

TEST_F(BakeCommand, TheFirstLayersAreCoarserScenes) {
  makeRandomFoam("200");
  for (const char* preset : {"exact", "default"}) {
    bake("b.froth", {"--preset", preset, "--no-measure"});
    render("b.froth", "three.pfm");
    double quality = 100;
    for (const char* layers : {"2", "1"}) {
      render("b.froth", "fewer.pfm", {"--layers", layers});
      const double found = psnr("three.pfm", "fewer.pfm");
      EXPECT_LT(found, quality) << preset << " " << layers;
      EXPECT_GT(found, 15) << preset << " " << layers;
      quality = found;
    }
  }
}

TEST_F(BakeCommand, TheReportSaysWhereTheBytesAreAndWhatWasLeftOut) {
  makeRandomFoam("200");
  const nlohmann::json baked = bake("b.froth", {"--preset", "default", "--no-walk", "--no-measure"});
  const nlohmann::json& sections = baked["sections"];
  EXPECT_GT(sections["types"].size(), 10u);
  uint64_t layers = 0;
  for (const auto& layer : sections["layers"]) layers += layer["bytes"].get<uint64_t>();
  EXPECT_EQ(layers, sections["all"]["bytes"]);
  EXPECT_LT(layers, baked["bytes"]);
  EXPECT_EQ(baked["statistics"]["hasWalkGraph"], false);
  EXPECT_EQ(baked["statistics"]["steinerCells"], 0);
  bool toldWalk = false;
  for (const auto& leftOut : baked["leftOut"]) toldWalk |= leftOut["what"] == "walk graph" && leftOut["savedBytes"] > 0;
  EXPECT_TRUE(toldWalk);
  EXPECT_EQ(frothJson({"info", "b.froth"})["sections"], sections);
}

TEST_F(BakeCommand, CellsThatNoCameraSeesCanBeCulled) {
  makeRandomFoam("400");
  const nlohmann::json all = bake("all.froth", {"--no-steiner"});
  const nlohmann::json seen = bake("seen.froth", {"--no-steiner", "--cull-unseen", "0.001"});
  const uint64_t culled = seen["statistics"]["unseenCulled"];
  EXPECT_GT(culled, 0u);
  EXPECT_LT(seen["statistics"]["liveCells"], all["statistics"]["liveCells"]);
  EXPECT_LT(seen["bytes"], all["bytes"]);
  render("all.froth", "all.pfm");
  render("seen.froth", "seen.pfm");
  EXPECT_GT(psnr("all.pfm", "seen.pfm"), 50);

  const ProgramRun blind = froth({"bake", "random.pt", "-o", "b.froth", "--cull-unseen", "0.01"});
  EXPECT_EQ(blind.exitCode, 2);
  EXPECT_NE(blind.err.find("cameras"), std::string::npos) << blind.err;
}

}  // namespace
}  // namespace froth::test
