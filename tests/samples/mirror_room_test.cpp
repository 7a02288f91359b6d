// froth_mirror_room without a display.
#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>

#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using testing::HasSubstr;

class MirrorRoom : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    makeRandomFoam("120");
  }

  ProgramRun show(const std::vector<std::string>& more, const std::string& asset = "random.froth") const {
    std::vector<std::string> arguments{asset, "--headless", "--size", "64x48", "-o", "frames"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(FROTH_MIRROR_ROOM, arguments, folder_);
  }
};

TEST_F(MirrorRoom, ShowsFramesWithTheirTimesAndWhatIsUnderAPixel) {
  const ProgramRun run = show({"--frames", "3", "--validate", "--json", "times.json", "--pick", "32,23"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  for (const char* file : {"frames/frame_0000.png", "frames/frame_0002.png", "frames/contact_sheet.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
  }
  EXPECT_THAT(run.out, HasSubstr("picked: foam, chunk 0 cell "));
  const nlohmann::json times = nlohmann::json::parse(readBytes(folder_ / "times.json"), nullptr, false);
  ASSERT_TRUE(times.is_object());
  EXPECT_EQ(times["width"], 64);
  for (const char* pass : {"shadow map", "meshes", "mirrored meshes", "foam", "walk set", "sun", "surround",
                           "reflection", "foreground", "light"}) {
    ASSERT_TRUE(times["passes"].contains(pass)) << pass;
    EXPECT_GE(times["passes"][pass]["median"].get<double>(), 0) << pass;
  }
}

TEST_F(MirrorRoom, ComparesItsLastFrameAndCatchesShadowsOnlyIfAskedTo) {
  ASSERT_EQ(show({"--frames", "1"}).exitCode, 0);
  std::filesystem::rename(folder_ / "frames/frame_0000.png", folder_ / "before.png");
  const std::vector<std::string> comparison{"--frames", "1", "--compare", "before.png", "--min-psnr", "60"};
  const ProgramRun same = show(comparison);
  EXPECT_EQ(same.exitCode, 0) << same.out << same.err;
  std::vector<std::string> unshadowed = comparison;
  unshadowed.insert(unshadowed.end(), {"--shadow-catching", "0"});
  const ProgramRun other = show(unshadowed);
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_THAT(other.err, HasSubstr("below --min-psnr 60"));
}

TEST_F(MirrorRoom, TellsWhatIsWrong) {
  const ProgramRun missing = show({"--frames", "1"}, "missing.froth");
  EXPECT_EQ(missing.exitCode, 3);
  EXPECT_THAT(missing.err, HasSubstr("missing.froth"));
  writeBytes(folder_ / "empty.gltf", "{\"asset\":{\"version\":\"2.0\"}}");
  const ProgramRun empty = show({"--frames", "1", "--room", "empty.gltf"});
  EXPECT_EQ(empty.exitCode, 3);
  EXPECT_THAT(empty.err, HasSubstr("empty.gltf: a mirror"));
  EXPECT_EQ(show({}).exitCode, 2);  // headless, but how many frames?
  EXPECT_EQ(show({"--frames", "1", "--shadow-catching", "2"}).exitCode, 2);
  EXPECT_EQ(runProgram(FROTH_MIRROR_ROOM, {"random.froth"}, folder_).exitCode, 1);  // no display
}

TEST_F(MirrorRoom, NeedsAWalkGraph) {
  frothWell({"bake", "random.pt", "--preset", "exact", "-o", "flat.froth", "--no-walk"});
  const ProgramRun run = show({"--frames", "1"}, "flat.froth");
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_THAT(run.err, HasSubstr("without --no-walk"));
}

}  // namespace
}  // namespace froth::test
