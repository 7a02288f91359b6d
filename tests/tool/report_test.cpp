// froth report: what it measures of a small scene, on the CPU and through the runtime.
#include <algorithm>
#include <cmath>
#include <set>

#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

class ReportCommand : public ToolTest {
 protected:
  nlohmann::json report(const std::string& input, std::vector<std::string> more) {
    std::vector<std::string> arguments{"report", input,     "--cameras", "cameras.json", "-o", "out",      "--size",
                                       "48x32",  "--views", "1",         "--search",     "0s", "--frames", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    frothWell(arguments);
    return nlohmann::json::parse(readBytes(folder_ / "out/report.json"));
  }

  // Into the records of an interrupted report's bakes.
  void writeLargestError(const char* attribute, double error) {
    for (const auto& file : std::filesystem::directory_iterator(folder_ / "out/work")) {
      if (file.path().extension() != ".json") continue;
      nlohmann::json record = nlohmann::json::parse(readBytes(file.path()));
      record["largestErrors"][attribute] = error;
      writeBytes(file.path(), record.dump());
    }
  }

  static const nlohmann::json* find(const nlohmann::json& report, const std::string& id) {
    for (const nlohmann::json& point : report["points"]) {
      if (point["id"] == id) return &point;
    }
    return nullptr;
  }
  static double meanError(const nlohmann::json& report, const std::string& id) {
    const nlohmann::json* point = find(report, id);
    EXPECT_NE(point, nullptr) << id;
    return point ? (*point)["errors"]["meanError"].get<double>() : NAN;
  }
};

TEST_F(ReportCommand, OnTheCpuShowsErrorsThatFallWithPrecision) {
  makeRandomFoam("60");
  const nlohmann::json figures = report("random.pt", {"--cpu"});
  EXPECT_EQ(figures["points"][0]["renderer"], "cpu");
  EXPECT_GT(figures["points"].size(), 60u);
  EXPECT_GT(meanError(figures, "cpu positionBits, all else exact=10"),
            4 * meanError(figures, "cpu positionBits, all else exact=14"));
  EXPECT_GT(meanError(figures, "cpu cutoff, all else exact=0.1"),
            10 * meanError(figures, "cpu cutoff, all else exact=0.0001"));
  EXPECT_LT(meanError(figures, "cpu preset=exact"), meanError(figures, "cpu preset=small"));
  for (const nlohmann::json& slope : figures["slopes"]) EXPECT_NE(slope["verdict"], "over its bound") << slope;
  EXPECT_EQ(figures["seed"], 1u);
  EXPECT_EQ(
      figures["command"],
      "froth report random.pt --cameras cameras.json --output out --size 48x32 --views 1 --search 0s --frames 1 --cpu");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/work"));
}

TEST_F(ReportCommand, ThroughTheRuntimeTimesRasterAndWalkAndWhatIsLeftOut) {
  if (!hasDevice()) FROTH_SKIP() << "no Vulkan device";
  makeRandomFoam("40");
  const nlohmann::json figures = report("random.pt", {"--no-images"});
  std::set<std::string> renderers, features;
  for (const nlohmann::json& point : figures["points"]) {
    renderers.insert(point["renderer"]);
    EXPECT_GT(point["diskBytes"], 0u) << point["id"];
    // Images of one foam by two renderers differ by rounding, not by more.
    if (point["id"] == "raster preset=exact") {
      EXPECT_GT(point["errors"]["psnr"], 55.0);
      EXPECT_GT(point["total"]["median"], 0.0);
      EXPECT_FALSE(point["passes"].empty());
    }
  }
  EXPECT_EQ(renderers, (std::set<std::string>{"raster", "walk"}));
  for (const nlohmann::json& feature : figures["features"]) features.insert(feature["feature"]);
  for (const char* name :
       {"view dependence", "displacement", "detail sites", "walk graph", "Steiner cells", "kept hits"}) {
    EXPECT_TRUE(features.count(name)) << name;
  }
  ASSERT_EQ(figures["rays"].size(), 21u);  // 7 kinds, 3 forms of what is prepared
  for (size_t i = 0; i < 21; ++i) {
    const nlohmann::json& rays = figures["rays"][i];
    EXPECT_GT(rays["time"]["median"], 0.0);
    EXPECT_EQ(rays.contains("psnr"), rays["rays"].get<std::string>().ends_with("base colours")) << rays;
    if (i >= 7) {
      EXPECT_GT(rays["residentBytes"], figures["rays"][i - 7]["residentBytes"]);
    }
  }
  const std::string html = readBytes(folder_ / "out/report.html");
  EXPECT_EQ(html.find("data:image/png"), std::string::npos);
  EXPECT_NE(html.find("mirrored, base colours"), std::string::npos);
  EXPECT_NE(html.find("positionBits"), std::string::npos);
}

TEST_F(ReportCommand, OfAnAssetWithoutAWalkGraphDrawsItAsItIs) {
  if (!hasDevice()) FROTH_SKIP() << "no Vulkan device";
  makeRandomFoam("40");
  frothWell({"bake", "random.pt", "--preset", "exact", "--no-walk", "-o", "flat.froth"});
  const nlohmann::json figures = report("flat.froth", {});
  for (const nlohmann::json& point : figures["points"]) EXPECT_EQ(point["renderer"], "raster");
  EXPECT_EQ(find(figures, "raster preset=exact"), nullptr);
  EXPECT_NE(find(figures, "raster layers=1"), nullptr);
  EXPECT_TRUE(figures["rays"].empty());
}

TEST_F(ReportCommand, GoesOnOnlyWithTheSameInputs) {
  makeRandomFoam("20");
  std::filesystem::create_directories(folder_ / "out/work");
  writeBytes(folder_ / "out/work/points.jsonl", "\"input of another scene\"\n");
  const ProgramRun run = froth({"report", "random.pt", "--cameras", "cameras.json", "-o", "out", "--cpu", "--resume"});
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_NE(run.err.find("points.jsonl"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("--resume"), std::string::npos) << run.err;
}

TEST_F(ReportCommand, TakesWhatAnInterruptedRunMeasured) {
  makeRandomFoam("20");
  frothWell({"synth", "two", "-o", "random.pt"});  // as quickly as it goes
  const std::vector<std::string> arguments{"report", "random.pt", "--cameras", "cameras.json", "-o",
                                           "out",    "--size",    "24x16",     "--cpu",        "--search",
                                           "0s",     "--frames",  "1",         "--views",      "1"};
  frothWell(arguments);
  const std::string whole = readBytes(folder_ / "out/report.json");
  // The log as an interruption leaves it: a point with a figure of its own, and half a line.
  nlohmann::json point = nlohmann::json::parse(whole)["points"][0];
  point["errors"]["ssim"] = 0.125;
  std::vector<std::string> again = arguments;
  again.push_back("--keep-work");
  frothWell(again);
  const std::string log = readBytes(folder_ / "out/work/points.jsonl");
  const std::string signature = log.substr(0, log.find('\n') + 1);
  // Of another version of Froth it is not taken.
  writeBytes(folder_ / "out/work/points.jsonl",
             "\"version 0.0.0" + signature.substr(signature.find(" device")) + point.dump() + "\n");
  again.back() = "--resume";
  const ProgramRun older = froth(again);
  EXPECT_EQ(older.exitCode, 2);
  EXPECT_NE(older.err.find("version 0.0.0"), std::string::npos) << older.err;
  writeBytes(folder_ / "out/work/points.jsonl", signature + point.dump() + "\n{\"id\": \"cpu lay");
  writeLargestError("sites", 1);
  const std::string printed = frothWell(again);
  const nlohmann::json resumed = nlohmann::json::parse(readBytes(folder_ / "out/report.json"));
  EXPECT_EQ(resumed["points"][0]["errors"]["ssim"], 0.125);
  // Whatever the slope of the images' errors: the stored positions lie further off than half a step.
  size_t over = 0;
  for (const nlohmann::json& slope : resumed["slopes"]) over += slope["verdict"] == "over its bound";
  EXPECT_EQ(over, 1u);
  EXPECT_NE(printed.find("sites off by 1 at"), std::string::npos) << printed;
  EXPECT_EQ(resumed["points"].size(), nlohmann::json::parse(whole)["points"].size());
  EXPECT_EQ(resumed["points"][5]["errors"], nlohmann::json::parse(whole)["points"][5]["errors"]);
}

}  // namespace
}  // namespace froth::test
