// `froth stability`: every built-in case through reference, float, raster and walk, with validation; and what the command writes.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "baker/stability/stiff_case.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

class StabilityCommand : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) GTEST_SKIP() << "no Vulkan device; `froth devices` says what is missing";
  }
};

class WholeFamily : public StabilityCommand, public testing::WithParamInterface<const char*> {};

// Fails for a case that is over its bound and is not known to be, with the cause written beside it.
TEST_P(WholeFamily, KeepsToItsBounds) {
  const ProgramRun run = froth({"stability", "--quiet", "--only", std::string(GetParam()) + "/*"});
  EXPECT_EQ(run.exitCode, 0) << run.out << run.err;
}

INSTANTIATE_TEST_SUITE_P(Stability, WholeFamily,
                         testing::Values("sites", "place", "sizes", "density", "faces", "eyes", "appearance", "views", "input"),
                         [](const auto& instance) { return std::string(instance.param); });

// A family that is not tested above would go unseen.
TEST(StabilityFamilies, AreAllTested) {
  const std::string tested[] = {"sites", "place", "sizes", "density", "faces", "eyes", "appearance", "views", "input"};
  for (const StiffCase& stiff : builtInCases()) {
    const std::string family = stiff.name.substr(0, stiff.name.find('/'));
    EXPECT_NE(std::find(std::begin(tested), std::end(tested), family), std::end(tested)) << stiff.name;
  }
}

TEST_F(StabilityCommand, ReplacesTheTableBetweenTheMarkersOfAFile) {
  const std::string begin = "<!-- made by `froth stability --markdown`: begin -->\n", end = "<!-- end -->\n";
  const std::filesystem::path path = folder_ / "STABILITY.md";
  writeBytes(path, "# Before\n" + begin + "old\n" + end + "after\n");
  frothWell({"stability", "--quiet", "--only", "views/1x1", "--markdown", "STABILITY.md"});
  const std::string text = readBytes(path);
  EXPECT_EQ(text.find("# Before\n" + begin), 0u);
  EXPECT_NE(text.find("| `views/1x1` | "), std::string::npos) << text;
  EXPECT_EQ(text.find("old"), std::string::npos);
  EXPECT_NE(text.find(end + "after\n"), std::string::npos);

  writeBytes(path, "no markers\n");
  const ProgramRun run = froth({"stability", "--quiet", "--only", "views/1x1", "--markdown", "STABILITY.md"});
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_NE(run.err.find("STABILITY.md"), std::string::npos);
}

TEST_F(StabilityCommand, NamesAPatternThatFitsNoCase) {
  const ProgramRun run = froth({"stability", "--only", "nothing/*"});
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_NE(run.err.find("--only nothing/*"), std::string::npos) << run.err;
}

TEST_F(StabilityCommand, RunsTheCasesOfAFoamOfTheUsers) {
  makeRandomFoam("60");
  const nlohmann::json figures = frothJson({"stability", "random.pt", "--cameras", "cameras.json", "--only", "foam/placed_1e+06*"});
  ASSERT_FALSE(figures["cases"].empty());
  for (const auto& one : figures["cases"]) EXPECT_EQ(one["verdict"], "within") << one.dump(2);
}

}  // namespace
}  // namespace froth::test
