// froth_flythrough with levels of detail: the view of levels, budgets, and its window.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include <gmock/gmock.h>

#include "base/image/image.h"
#include "samples/flythrough/level_colours.h"
#include "tests/samples/level_gallery.h"
#include "tests/samples/x_server.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using testing::HasSubstr;

float decode(float coded) { return coded <= 0.04045f ? coded / 12.92f : std::pow((coded + 0.055f) / 1.055f, 2.4f); }

// Whose colour it is, however bright; none: of no level.
std::optional<size_t> levelOf(const float* coded) {
  // 8 bits step by 0.4 % of the brightest pixel; the darkest have a quarter of it. Twice: that of the greatest channel
  // counts too.
  constexpr float kMostDifference = 0.03f;
  const LevelColour light = {decode(coded[0]), decode(coded[1]), decode(coded[2])};
  const float greatest = std::ranges::max(light);
  for (size_t level = 0; level < kLevelColours.size(); ++level) {
    bool isIts = true;
    for (size_t c = 0; c < 3; ++c) {
      isIts = isIts && std::abs(light[c] / greatest - kLevelColours[level][c]) <= kMostDifference;
    }
    if (isIts) return level;
  }
  return std::nullopt;
}

class FlythroughLevels : public LevelGallery {
 protected:
  ProgramRun fly(const std::vector<std::string>& more, const std::string& asset = "gallery.froth") const {
    std::vector<std::string> arguments{asset, "--cameras", "cameras.json", "--headless",
                                       "-o",  "frames",    "--json",       "flight.json"};
    if (std::ranges::find(more, "--size") == more.end()) arguments.insert(arguments.end(), {"--size", "96x64"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(FROTH_FLYTHROUGH, arguments, folder_);
  }
  nlohmann::json frames() const {
    return nlohmann::json::parse(readBytes(folder_ / "flight.json"), nullptr, false)["frames"];
  }

  // Of the pixels of a frame; a pixel of no level's colour fails the test. Black: there is no cell.
  std::set<size_t> levelsInPicture(size_t frame) const {
    char name[32];
    std::snprintf(name, sizeof(name), "frames/frame_%04zu.png", frame);
    const Result<Image> image = readImage(folder_ / name);
    if (!image) {
      ADD_FAILURE() << image.error().message;
      return {};
    }
    std::set<size_t> levels;
    for (uint32_t y = 0; y < image->height; ++y) {
      for (uint32_t x = 0; x < image->width; ++x) {
        const float* const pixel = image->pixel(x, y);
        if (std::max({pixel[0], pixel[1], pixel[2]}) == 0) continue;
        const std::optional<size_t> level = levelOf(pixel);
        EXPECT_TRUE(level) << name << " at " << x << ", " << y;
        if (level) levels.insert(*level);
      }
    }
    return levels;
  }
};

TEST_F(FlythroughLevels, ShowsOfEachPixelTheLevelOfADrawnChunk) {
  const ProgramRun run = fly({"--frames", "12", "--renderer", "levels", "--budget", "64MB", "--validate"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("last frame: chunks drawn by level "));
  std::set<size_t> all;
  size_t mixtures = 0;
  const nlohmann::json told = frames();
  ASSERT_EQ(told.size(), 12u);
  ASSERT_LE(told[0]["drawnByLevel"].size(), kLevelColours.size()) << "more levels than colours";
  for (size_t frame = 0; frame < told.size(); ++frame) {
    const std::set<size_t> seen = levelsInPicture(frame);
    EXPECT_FALSE(seen.empty()) << frame;
    for (const size_t level : seen) EXPECT_GT(told[frame]["drawnByLevel"].at(level), 0) << frame << ", level " << level;
    all.insert(seen.begin(), seen.end());
    mixtures += seen.size() > 1;
  }
  EXPECT_GE(all.size(), 3u) << "they come level by level";
  EXPECT_GE(mixtures, 1u);
}

TEST_F(FlythroughLevels, DrawsTheFloorOrTheFinestByDetail) {
  for (const auto& [detail, isFinest] : {std::pair("0.0001", false), std::pair("1000", true)}) {
    const ProgramRun run = fly({"--frames", "2", "--settled", "--detail", detail, "--renderer", "levels"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    for (const nlohmann::json& frame : frames()) {
      EXPECT_TRUE(frame["isSettled"]);
      const nlohmann::json& drawn = frame["drawnByLevel"];
      const auto count = static_cast<size_t>(std::ranges::count_if(drawn, [](const auto& n) { return n != 0; }));
      EXPECT_EQ(count, 1u) << drawn;
      EXPECT_GT(isFinest ? drawn.front() : drawn.back(), 0) << drawn;
    }
    EXPECT_EQ(levelsInPicture(1).size(), 1u);
  }
}

// Views take most of such a budget, and are refused what they want besides.
TEST_F(FlythroughLevels, SettlesWithinATightBudget) {
  const ProgramRun run = fly({"--frames", "3", "--settled", "--budget", "10MB", "--size", "320x200"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  for (const nlohmann::json& frame : frames()) {
    EXPECT_TRUE(frame["isSettled"]);
    EXPECT_LT(frame["budgetBytes"], 10 << 20);
  }
}

TEST_F(FlythroughLevels, HasAWindowWithPanels) {
  const XServer server;
  if (!server.isRunning()) FROTH_SKIP() << "no Xvfb";
  const ProgramRun run = runProgram(FROTH_FLYTHROUGH,
                                    {"gallery.froth", "--cameras", "cameras.json", "--frames", "12", "--size",
                                     "320x240", "--renderer", "levels", "--validate"},
                                    folder_);
  EXPECT_EQ(run.exitCode, 0) << run.err;
}

TEST_F(FlythroughLevels, RefusesWhatAsksForLevelsInVain) {
  makeRandomFoam("60");
  const ProgramRun run = fly({"--frames", "1", "--renderer", "levels"}, "random.froth");
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_THAT(run.err, HasSubstr("--lod"));
  EXPECT_EQ(fly({"--frames", "1", "--budget", "much"}).exitCode, 2);
  EXPECT_EQ(fly({"--frames", "1", "--detail", "0"}).exitCode, 2);
  EXPECT_EQ(runProgram(FROTH_FLYTHROUGH, {"gallery.froth", "--settled"}, folder_).exitCode, 2);
}

}  // namespace
}  // namespace froth::test
