// What the program says to wrong command lines: exit code 2, a message on stderr, nothing on disk.
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

class Usage : public ToolTest {
 protected:
  void expectUsageError(const std::vector<std::string>& arguments, const std::string& named) const {
    const ProgramRun run = froth(arguments);
    EXPECT_EQ(run.exitCode, 2) << run.err;
    EXPECT_EQ(run.err.rfind("froth: ", 0), 0u) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << "'" << named << "' is missing in: " << run.err;
    EXPECT_TRUE(filesInFolder().empty());
  }
};

TEST_F(Usage, ACommandIsNeeded) { expectUsageError({}, "command"); }

TEST_F(Usage, AnUnknownCommandIsRefused) { expectUsageError({"fry"}, "fry"); }

TEST_F(Usage, AnUnknownOptionIsNamed) { expectUsageError({"info", "a.froth", "--sise", "3"}, "--sise"); }

TEST_F(Usage, AMissingOptionIsNamed) { expectUsageError({"bake", "a.pt"}, "--output"); }

TEST_F(Usage, AnUnknownSceneIsNamed) { expectUsageError({"synth", "moon", "-o", "a.pt"}, "moon"); }

TEST_F(Usage, ACellCountBeyond32BitsIsRefused) {
  expectUsageError({"synth", "random", "--cells", "1000000000000", "-o", "a.pt"}, "1000000000000");
}

TEST_F(Usage, ASizeMustBeTwoNumbers) {
  for (const char* size : {"640", "640x", "x480", "0x480", "640x480x3", "-1x5", "99999x2"}) {
    expectUsageError({"render", "a.froth", "--cameras", "c.json", "--renderer", "raster", "--size", size, "-o", "d"},
                     size);
  }
}

TEST_F(Usage, NumbersOutOfRangeAreNamedWithWhatToGive) {
  const std::vector<std::string> render{"render", "a.froth", "--cameras", "c.json", "--renderer", "raster", "-o", "d"};
  const std::vector<std::string> bake{"bake", "a.pt", "-o", "a.froth"};
  const auto expectRefused = [this](std::vector<std::string> command, const std::string& option,
                                    const std::string& value) {
    command.insert(command.end(), {option, value});
    expectUsageError(command, option + ": found '" + value + "'; give a ");
  };
  for (const char* cutoff : {"nan", "-1", "2", "half"}) expectRefused(render, "--cutoff", cutoff);
  for (const char* view : {"-1", "1.5", "one"}) expectRefused(render, "--view", view);
  for (const char* limit : {"nan", "inf", "-1", "1e39", "far"}) {
    expectRefused(bake, "--near-ratio", limit);
    expectRefused(bake, "--near-depth", limit);
  }
  expectRefused(bake, "--position-bits", "23");
  expectRefused(bake, "--lobes", "33");
  expectRefused(bake, "--codebook", "65537");
  expectRefused(bake, "--colour-step", "0.3");
  expectRefused(bake, "--cull-unseen", "1.5");
  expectRefused(bake, "--chunk-cells", "0");
  expectRefused(bake, "--threads", "0");
}

TEST_F(Usage, EyesThatCannotBeAreNamedWithWhatToGive) {
  for (const std::string eyes : {"cameras+0", "cameras+nan", "cameras+1e300", "box:0,0,0,1,1", "box:0,2,0,1,1,1",
                                 "box:0,0,0,1,1,1,", "anywhere"}) {
    expectUsageError({"bake", "a.pt", "-o", "a.froth", "--eyes", eyes}, "found '" + eyes + "'; give cameras");
  }
}

TEST_F(Usage, AnUnknownPresetIsNamed) {
  expectUsageError({"bake", "a.pt", "-o", "a.froth", "--preset", "tiny"}, "tiny");
}

TEST_F(Usage, LayersBelongToAssets) {
  expectUsageError({"render", "a.pt", "--cameras", "c.json", "--renderer", "reference", "--layers", "1", "-o", "d"},
                   "--layers");
}

TEST_F(Usage, AnUnknownRendererIsNamed) {
  expectUsageError({"render", "a.froth", "--cameras", "c.json", "--renderer", "magic", "-o", "d"}, "magic");
}

TEST_F(Usage, PrecisionBelongsToTheReference) {
  expectUsageError(
      {"render", "a.froth", "--cameras", "c.json", "--renderer", "walk", "--precision", "float", "-o", "d"},
      "--precision");
}

TEST_F(Usage, APngHoldsNeitherDepthNorLinearColour) {
  const std::vector<std::string> common{"render", "a.froth", "--cameras", "c.json", "--renderer",
                                        "raster", "--view",  "0",         "-o",     "a.png"};
  std::vector<std::string> depth = common, linear = common;
  depth.insert(depth.end(), {"--channel", "depth"});
  linear.push_back("--linear");
  expectUsageError(depth, "depth");
  expectUsageError(linear, "linear");
}

TEST_F(Usage, GroundTruthBelongsToTheGallery) {
  expectUsageError({"synth", "random", "--ground-truth", "c.json", "-o", "d"}, "--ground-truth");
}

TEST_F(Usage, ATilingNeedsSourceAndCount) { expectUsageError({"synth", "tile", "--count", "2", "-o", "a.pt"}, "--of"); }

TEST_F(Usage, AnAssetIsNamedLikeOne) { expectUsageError({"bake", "a.pt", "-o", "a.bin"}, ".froth"); }

TEST_F(Usage, FewerThanHundredFramesAreNoMeasurement) {
  expectUsageError({"bench", "a.froth", "--cameras", "c.json", "--frames", "10"}, "--frames");
}

TEST_F(Usage, HelpIsNoError) {
  const ProgramRun run = froth({"bake", "--help"});
  EXPECT_EQ(run.exitCode, 0);
  EXPECT_NE(run.out.find("--near-ratio"), std::string::npos);
}

TEST_F(Usage, AViewThatIsNotThereIsNamed) {
  CameraSet cameras;
  cameras.views.push_back(viewOfRandomFoam(8, 8));
  ASSERT_TRUE(writeCameras(folder_ / "cameras.json", cameras));
  const ProgramRun run = froth(
      {"render", "a.froth", "--cameras", "cameras.json", "--view", "3", "--renderer", "reference", "-o", "a.pfm"});
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_NE(run.err.find("--view 3: cameras.json has 1 views"), std::string::npos) << run.err;
}

TEST_F(Usage, AFolderThatIsNotThereIsToldBeforeTheWork) {
  for (const std::vector<std::string>& command : {std::vector<std::string>{"bake", "missing.pt", "-o", "none/a.froth"},
                                                  std::vector<std::string>{"synth", "random", "-o", "none/a.pt"}}) {
    const ProgramRun run = froth(command);
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_NE(run.err.find("none/a."), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("folder none"), std::string::npos) << run.err;
    EXPECT_TRUE(filesInFolder().empty());
  }
}

TEST_F(Usage, FiguresThatCannotBeWrittenAreAFailure) {
  makeRandomFoam("12");
  const ProgramRun run =
      runProgram("/bin/sh", {"-c", programPath(FROTH_TOOL).string() + " info random.froth > /dev/full"}, folder_);
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_NE(run.err.find("standard output"), std::string::npos) << run.err;
}

TEST_F(Usage, HelpManAndCompletionNameEveryCommandAndItsOptions) {
  const std::string help = frothWell({"help"}), man = frothWell({"man"}), completion = frothWell({"completion"});
  for (const char* command : {"synth", "train", "evaluate", "bake", "render", "info", "verify", "compare", "bench",
                              "report", "stability", "devices"}) {
    EXPECT_NE(help.find(std::string("  ") + command + " "), std::string::npos) << command;
    EXPECT_NE(man.find(std::string("\"froth ") + command + "\""), std::string::npos) << command;
    EXPECT_NE(completion.find(std::string("    ") + command + ") options='"), std::string::npos) << command;
  }
  EXPECT_NE(frothWell({"help", "bake"}).find("Usage: froth bake"), std::string::npos);
  EXPECT_NE(frothWell({"help", "bake"}).find("--preset"), std::string::npos);
  EXPECT_NE(man.find("\\-\\-preset"), std::string::npos);
  EXPECT_NE(completion.find("--preset"), std::string::npos);
  expectUsageError({"help", "bakery"}, "bakery");
  EXPECT_EQ(frothWell({"--version"}).substr(0, 2), "0.");
}

TEST_F(Usage, DurationsHaveAUnit) {
  for (const char* wrong : {"5", "5m", "five min", "nan", "-1s", "1e9h"}) {
    expectUsageError({"stability", "--search", wrong}, "500ms, 90s, 5min or 1h");
  }
}

}  // namespace
}  // namespace froth::test
