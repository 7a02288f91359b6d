// What `froth bench` counts and how `froth compare-bench` judges.
#include <gtest/gtest.h>

#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using Json = nlohmann::json;

Json interval(double median, double noise) {
  return {{"median", median}, {"p5", median - noise}, {"p95", median + noise}};
}

Json makeResult(double cull, double raster, double noise) {
  return {{"input", "a.froth"},
          {"device", "d"},
          {"driver", "1"},
          {"renderer", "raster"},
          {"output", "rgba16f"},
          {"cutoff", 0.001},
          {"width", 64},
          {"height", 64},
          {"layers", 3},
          {"cells", 10},
          {"isCounting", false},
          {"assetBytes", 1000},
          {"viewBytes", 2000},
          {"memory", {{"asset", {{"cells", 1000}}}, {"view", {{"pairs", 16}}}}},
          {"cycles",
           {{"count", 9},
            {"total", interval(cull + raster, noise)},
            {"passes", {{"cull", interval(cull, noise)}, {"raster", interval(raster, noise)}}}}}};
}

class CompareBench : public ToolTest {
 protected:
  Json compare(const Json& a, const Json& b) const {
    writeBytes(folder_ / "a.json", a.dump());
    writeBytes(folder_ / "b.json", b.dump());
    return frothJson({"compare-bench", "a.json", "b.json"});
  }
};

TEST_F(CompareBench, CallsOnlyDifferencesBeyondTheNoiseFasterOrSlower) {
  const Json result = compare(makeResult(1.0, 2.0, 0.1), makeResult(1.15, 1.0, 0.1));
  EXPECT_EQ(result["times"]["cull"]["verdict"], "tie");
  EXPECT_EQ(result["times"]["raster"]["verdict"], "faster");
  EXPECT_EQ(result["times"]["total"]["verdict"], "faster");
  EXPECT_DOUBLE_EQ(result["times"]["raster"]["ratio"].get<double>(), 0.5);
  EXPECT_EQ(compare(makeResult(1.0, 2.0, 0.01), makeResult(1.15, 1.0, 0.01))["times"]["cull"]["verdict"], "slower");
}

TEST_F(CompareBench, NamesWhatElseDiffersAndListsTheBytes) {
  Json other = makeResult(1.0, 2.0, 0.1);
  other["device"] = "e";
  other["maxEntries"] = 64;
  other["memory"]["view"]["pairs"] = 32;
  const Json result = compare(makeResult(1.0, 2.0, 0.1), other);
  ASSERT_EQ(result["differences"].size(), 2u);
  EXPECT_EQ(result["differences"][0], "device: \"d\" and \"e\"");
  EXPECT_EQ(result["differences"][1], "maxEntries: 0 and 64");
  EXPECT_EQ(result["counts"]["bytes of view, pairs"]["b"], 32);
  const std::string table = frothWell({"compare-bench", "a.json", "b.json"});
  EXPECT_NE(table.find("differs: device"), std::string::npos) << table;
  EXPECT_NE(table.find("1.0000 [0.9000, 1.1000]"), std::string::npos) << table;
  EXPECT_NE(table.find("tie"), std::string::npos) << table;
}

TEST_F(CompareBench, NamesTheFieldThatIsMissing) {
  Json broken = makeResult(1, 2, 0.1);
  broken.erase("cycles");
  writeBytes(folder_ / "a.json", makeResult(1, 2, 0.1).dump());
  writeBytes(folder_ / "b.json", broken.dump());
  const ProgramRun run = froth({"compare-bench", "a.json", "b.json"});
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_NE(run.err.find("cycles"), std::string::npos) << run.err;
  writeBytes(folder_ / "b.json", "no json");
  EXPECT_NE(froth({"compare-bench", "a.json", "b.json"}).err.find("b.json"), std::string::npos);
}

using BenchCounters = ToolTest;

TEST_F(BenchCounters, AreAveragesPerRayAndPerSubTile) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("60", 2);
  for (const std::string renderer : {"raster", "walk"}) {
    const bool isWalk = renderer == "walk";
    const Json bench = frothJson({"bench", "random.froth", "--cameras", "cameras.json", "--size", "16x16", "--frames",
                                  "100", "--warmup", "0s", "--renderer", renderer, "--counters"});
    const Json& perRay = bench["work"]["perRay"];
    EXPECT_GT(perRay["ballHits"].get<double>(), 0);
    EXPECT_LE(perRay["colours"].get<double>(), perRay["ballHits"].get<double>());
    EXPECT_EQ(perRay["steps"].get<double>() > 0, isWalk);
    EXPECT_EQ(perRay["neighbours"].get<double>() > 0, isWalk);
    EXPECT_EQ(bench["work"]["perSubTile"]["entries"].get<double>() > 0, !isWalk);
    EXPECT_EQ(perRay["planes"].get<double>() > 0, !isWalk);
    uint64_t viewBytes = 0;
    for (const auto& [name, bytes] : bench["memory"]["view"].items()) viewBytes += bytes.get<uint64_t>();
    EXPECT_EQ(bench["viewBytes"].get<uint64_t>(), viewBytes);
    EXPECT_EQ(bench["cycles"]["count"], 50);
  }
}

}  // namespace
}  // namespace froth::test
