// froth_flythrough without a display, against `froth render`.
#include <cstdlib>

#include <gmock/gmock.h>

#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using testing::HasSubstr;

class Flythrough : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    makeRandomFoam("120", 3);
  }

  ProgramRun fly(const std::vector<std::string>& more, const std::string& asset = "random.froth") const {
    std::vector<std::string> arguments{asset,       "--headless",   "--size", "96x64",
                                       "--cameras", "cameras.json", "-o",     "frames"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(FROTH_FLYTHROUGH, arguments, folder_);
  }
  void renderView(const std::string& view, const std::string& output) const {
    frothWell({"render", "random.froth", "--cameras", "cameras.json", "--view", view, "--renderer", "raster", "--size",
               "96x64", "-o", output});
  }
};

TEST_F(Flythrough, ShowsWhatFrothRenderShows) {
  renderView("0", "first.png");
  renderView("2", "last.png");
  for (const char* renderer : {"raster", "walk"}) {
    const ProgramRun first =
        fly({"--frames", "1", "--compare", "first.png", "--min-psnr", "45", "--renderer", renderer, "--validate"});
    EXPECT_EQ(first.exitCode, 0) << first.err;
    const ProgramRun last = fly({"--frames", "3", "--compare", "last.png", "--min-psnr", "45", "--renderer", renderer});
    EXPECT_EQ(last.exitCode, 0) << last.err;
  }
}

TEST_F(Flythrough, FailsWhenThePictureIsAnother) {
  renderView("0", "first.png");
  const ProgramRun run = fly({"--frames", "3", "--compare", "first.png", "--min-psnr", "45"});
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("below --min-psnr 45"));
}

TEST_F(Flythrough, WritesEveryFrameAndASheet) {
  const ProgramRun run = fly({"--frames", "14"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "frames")) {
    EXPECT_EQ(entry.path().extension(), ".png") << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 15u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "frames/frame_0013.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "frames/contact_sheet.png"));
}

TEST_F(Flythrough, OrbitsAnAssetWithoutCameras) {
  const ProgramRun run = runProgram(
      FROTH_FLYTHROUGH, {"random.froth", "--headless", "--size", "32x32", "--frames", "2", "-o", "f"}, folder_);
  EXPECT_EQ(run.exitCode, 0) << run.err;
}

TEST_F(Flythrough, BeginsAtTheStartViewOfAnAssetWithoutAPath) {
  frothWell({"bake", "random.pt", "--cameras", "cameras.json", "-o", "started.froth"});
  frothWell({"render", "started.froth", "--cameras", "cameras.json", "--view", "0", "--renderer", "raster", "--size",
             "96x64", "-o", "first.png"});
  const ProgramRun run = runProgram(FROTH_FLYTHROUGH,
                                    {"started.froth", "--headless", "--size", "96x64", "--frames", "2", "-o", "frames",
                                     "--compare", "first.png", "--min-psnr", "45"},
                                    folder_);
  EXPECT_EQ(run.exitCode, 0) << run.err;
}

TEST_F(Flythrough, RefusesAFolderOfCameras) {
  std::filesystem::create_directory(folder_ / "photos");
  const ProgramRun run =
      runProgram(FROTH_FLYTHROUGH,
                 {"random.froth", "--headless", "--cameras", "photos", "--frames", "1", "-o", "frames"}, folder_);
  EXPECT_EQ(run.exitCode, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("photos"));
}

TEST_F(Flythrough, RefusesADamagedAsset) {
  writeBytes(folder_ / "bad.froth", readBytes(folder_ / "random.froth").substr(0, 500));
  const ProgramRun run = fly({"--frames", "1"}, "bad.froth");
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_THAT(run.err, HasSubstr("bad.froth"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "frames"));
}

TEST_F(Flythrough, RefusesAPoseThatIsNoRotation) {
  for (const char* corner : {"-1", "2"}) {
    const std::string rows = std::string("[[") + corner + ",0,0,0],[0,1,0,0],[0,0,1,0]]";
    writeBytes(folder_ / "cameras.json", R"({"views": [{"height": 8, "fy": 8, "world_from_camera": )" + rows + "}]}");
    const ProgramRun run = fly({"--frames", "1"});
    EXPECT_EQ(run.exitCode, 3);
    EXPECT_THAT(run.err, HasSubstr("cameras.json: views 0, field 'world_from_camera': found a determinant of " +
                                   std::string(corner)));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "frames"));
  }
}

TEST_F(Flythrough, RefusesWrongArguments) {
  EXPECT_EQ(fly({"--frames", "1", "--size", "wide"}).exitCode, 2);
  EXPECT_EQ(fly({}).exitCode, 2);  // headless, but how many frames?
}

TEST_F(Flythrough, SaysWhatToDoWithoutADisplay) {
  const ProgramRun run = runProgram(FROTH_FLYTHROUGH, {"random.froth"}, folder_);
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("--headless"));
}

}  // namespace
}  // namespace froth::test
