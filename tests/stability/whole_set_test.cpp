// `froth stability`: every built-in case through reference, float, raster and walk, with validation; and what the
// command writes.
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "measure/marked_text.h"
#include "measure/stability/cases/stiff_case.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

class StabilityCommand : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) FROTH_SKIP() << "no Vulkan device; `froth devices` says what is missing";
  }
};

// The two presets that are also drawn as games draw them: all four, which the GPU suite runs, take twice as long.
class WholeSet : public StabilityCommand, public ::testing::WithParamInterface<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, WholeSet, ::testing::Values("exact", "default"),
                         [](const auto& one) { return one.param; });

// Fails for a case that is over its bound and is not known to be, with the cause written beside it.
TEST_P(WholeSet, KeepsToItsBounds) {
  const ProgramRun run = froth({"stability", "--quiet", "--presets", GetParam(), "--json"});
  const nlohmann::json figures = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_FALSE(figures.is_discarded()) << run.out << run.err;
  EXPECT_EQ(figures["counts"]["cases"], builtInCases().size());
  for (const auto& one : figures["cases"]) {
    EXPECT_EQ(one["unexplained"].size(), 0u) << one["name"] << one["unexplained"].dump(1);
    EXPECT_TRUE(one["presets"].size() == 1 || one["verdict"] == "refused") << one["name"];
  }
  EXPECT_EQ(run.exitCode, 0) << run.err;
}

TEST_F(StabilityCommand, APageWithoutItsMarkersIsRefusedBeforeTheSetRuns) {
  writeBytes(folder_ / "STABILITY.md", "no markers\n");
  const ProgramRun run = froth({"stability", "--quiet", "--markdown", "STABILITY.md"});
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_NE(run.err.find("STABILITY.md"), std::string::npos) << run.err;
  EXPECT_EQ(readBytes(folder_ / "STABILITY.md"), "no markers\n");
}

TEST(MarkedText, IsReplacedBetweenItsMarkersAlone) {
  std::string text =
      "# Before\n<!-- made by `froth stability --markdown`: begin -->\nold\n<!-- end -->\nmiddle\n"
      "<!-- forms, made by `froth stability --markdown`: begin -->\nolder\n<!-- end -->\nafter\n";
  replaceMarked(text, "forms, ", "new forms\n");
  replaceMarked(text, "", "new\n");
  EXPECT_EQ(text,
            "# Before\n<!-- made by `froth stability --markdown`: begin -->\nnew\n<!-- end -->\nmiddle\n"
            "<!-- forms, made by `froth stability --markdown`: begin -->\nnew forms\n<!-- end -->\nafter\n");
}

TEST_F(StabilityCommand, APartialTableIsNotWritten) {
  for (const auto& [option, value] : {std::pair{"--only", "views/1x1"}, {"--presets", "exact"}}) {
    const ProgramRun run = froth({"stability", option, value, "--markdown", "STABILITY.md"});
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_NE(run.err.find(option), std::string::npos) << run.err;
  }
  EXPECT_TRUE(filesInFolder().empty());
}

// What searches have found, through raster and walk: `froth stability --search` writes such files.
TEST_F(StabilityCommand, FoundCasesHoldOnTheDevice) {
  const nlohmann::json figures =
      frothJson({"stability", "--replay", (sourceFolder() / "tests/stability/found").string()});
  EXPECT_GE(figures["counts"]["cases"], 25);
  EXPECT_EQ(figures["counts"]["beyond"], 0);
  for (const auto& one : figures["cases"]) {
    EXPECT_EQ(one["unexplained"].size(), 0u) << one["name"] << one["unexplained"].dump(1);
  }
}

TEST_F(StabilityCommand, AFolderWithoutCasesIsRefused) {
  const ProgramRun run = froth({"stability", "--replay", folder_.string()});
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_NE(run.err.find("no case files"), std::string::npos) << run.err;
}

TEST_F(StabilityCommand, SearchesAndFindsNothing) {
  const ProgramRun run = froth({"stability", "--quiet", "--search", "3s", "--seed", "1", "-o", "found", "--json"});
  const nlohmann::json figures = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_FALSE(figures.is_discarded()) << run.out << run.err;
  EXPECT_GE(figures["tried"], 1);
  EXPECT_FALSE(figures["device"].get<std::string>().empty()) << run.err;
  EXPECT_FALSE(figures["driver"].get<std::string>().empty());
  EXPECT_EQ(figures["failing"], 0) << figures["found"].dump(1);
  EXPECT_EQ(run.exitCode, 0) << run.err;
}

TEST_F(StabilityCommand, ASearchesOptionsNeedIt) {
  for (const char* option : {"--seed", "-o"}) {
    const ProgramRun run = froth({"stability", option, "1"});
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_NE(run.err.find("--search"), std::string::npos) << run.err;
  }
  for (const char* option : {"--only", "--markdown", "--presets"}) {
    EXPECT_EQ(froth({"stability", "--search", "1min", option, "exact"}).exitCode, 2) << option;
  }
  EXPECT_TRUE(filesInFolder().empty());
}

TEST_F(StabilityCommand, NamesThePresetsThatThereAre) {
  const ProgramRun run = froth({"stability", "--presets", "exact,huge"});
  EXPECT_EQ(run.exitCode, 2);
  for (const char* part : {"huge", "exact", "high", "default", "small"}) {
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
  }
}

TEST_F(StabilityCommand, NamesAPatternThatFitsNoCase) {
  const ProgramRun run = froth({"stability", "--only", "nothing/*"});
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_NE(run.err.find("--only nothing/*"), std::string::npos) << run.err;
}

TEST_F(StabilityCommand, RunsTheCasesOfAFoamOfTheUsers) {
  makeRandomFoam("60");
  const nlohmann::json figures =
      frothJson({"stability", "random.pt", "--cameras", "cameras.json", "--only", "foam/placed_1e+06*"});
  ASSERT_FALSE(figures["cases"].empty());
  for (const auto& one : figures["cases"]) EXPECT_EQ(one["verdict"], "within") << one.dump(2);
}

}  // namespace
}  // namespace froth::test
