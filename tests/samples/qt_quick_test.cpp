// froth_qt_quick in a window of Xvfb, against the double reference blended between its items.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>

#include "base/image/image.h"
#include "base/image/mean_square.h"
#include "tests/samples/x_server.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using testing::HasSubstr;

constexpr uint32_t kWidth = 320, kHeight = 240;

// Of samples/qt_quick/scene.qml.
struct Box {
  uint32_t left, top, width, height;
  bool holds(uint32_t x, uint32_t y) const { return x >= left && x < left + width && y >= top && y < top + height; }
};
constexpr Box kCaption{12, kHeight - 44, 150, 32}, kButton{kWidth - 76, kHeight - 44, 64, 32};
constexpr float kTop[] = {0x20 / 255.0f, 0x30 / 255.0f, 0x40 / 255.0f};
constexpr float kBottom[] = {0xc0 / 255.0f, 0xd0 / 255.0f, 0xe0 / 255.0f};
constexpr float kCaptionColour[] = {0x10 / 255.0f, 0x14 / 255.0f, 0x18 / 255.0f};
constexpr float kCaptionAlpha = 0xa0 / 255.0f;
constexpr float kButtonColour[] = {0xc0 / 255.0f, 0x90 / 255.0f, 0};

// Rounding to 8 bits: half a step each for the foam's colour, its alpha, the background and the sum. Half a step more
// for floats, and for rays that end at a transmittance of 1e-3.
constexpr float kMostDifference = 2.5f / 255;

class QtQuick : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
    if (std::string(FROTH_QT_QUICK).empty()) FROTH_SKIP() << "built without Qt 6";
    if (!server_.isRunning()) FROTH_SKIP() << "no Xvfb";
    CameraSet cameras;
    cameras.views.push_back(viewOfRandomFoam(kWidth, kHeight));
    ASSERT_TRUE(writeCameras(folder_ / "cameras.json", cameras));
    frothWell({"synth", "random", "--cells", "120", "-o", "random.pt"});
    frothWell({"bake", "random.pt", "--preset", "exact", "-o", "random.froth", "--cameras", "cameras.json"});
  }

  ProgramRun show(const std::vector<std::string>& arguments) const {
    return runProgram(FROTH_QT_QUICK, arguments, folder_);
  }
  ProgramRun showHeadless(const std::string& size, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"random.froth", "--headless", "--frames", "6",         "--size",
                                       size,           "-o",         "out",      "--validate"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return show(arguments);
  }

  Image imageOf(const std::string& name) const {
    Result<Image> image = readImage(folder_ / name);
    EXPECT_TRUE(image) << image.error().message;
    return image ? *image : Image{};
  }

  // The background, and the foam over it.
  Image foamOverGradient() const {
    for (const char* channel : {"colour", "alpha"}) {
      frothWell({"render", "random.froth", "--cameras", "cameras.json", "--view", "0", "--renderer", "reference",
                 "--channel", channel, "-o", std::string(channel) + ".pfm"});
    }
    Image picture = imageOf("colour.pfm");
    const Image alpha = imageOf("alpha.pfm");
    for (uint32_t y = 0; y < picture.height; ++y) {
      const float share = (static_cast<float>(y) + 0.5f) / static_cast<float>(picture.height);
      for (uint32_t x = 0; x < picture.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          float& value = picture.pixel(x, y)[c];
          value = std::min(1.0f, value + (1 - *alpha.pixel(x, y)) * (kTop[c] + share * (kBottom[c] - kTop[c])));
        }
      }
    }
    return picture;
  }

  // `expected` is without the items above.
  static void expectFoamAndItems(const Image& seen, Image expected) {
    ASSERT_EQ(seen.width, kWidth);
    ASSERT_EQ(seen.height, kHeight);
    float mostDifference = 0, brightest = 0;
    Image foam = seen;
    for (uint32_t y = 0; y < kHeight; ++y) {
      for (uint32_t x = 0; x < kWidth; ++x) {
        const bool isText = kCaption.holds(x, y) && x >= kCaption.left + 4;  // the text starts after a margin
        for (int c = 0; c < 3; ++c) {
          float& wanted = expected.pixel(x, y)[c];
          if (kCaption.holds(x, y)) wanted += kCaptionAlpha * (kCaptionColour[c] - wanted);
          const float difference = std::abs(seen.pixel(x, y)[c] - wanted);
          if (isText) brightest = std::max(brightest, seen.pixel(x, y)[c]);
          if (isText || kButton.holds(x, y)) {
            foam.pixel(x, y)[c] = wanted;
          } else {
            mostDifference = std::max(mostDifference, difference);
          }
        }
      }
    }
    EXPECT_LE(mostDifference, kMostDifference);
    EXPECT_GE(decibels(meanSquare(foam, expected)), 55);
    EXPECT_GT(brightest, 0.9f) << "the caption's white text is missing";
    for (int c = 0; c < 3; ++c) EXPECT_EQ(seen.pixel(kButton.left + 2, kButton.top + 2)[c], kButtonColour[c]);
  }

  const XServer server_;
};

TEST_F(QtQuick, ShowsTheFoamOverTheItemsBelowItAndUnderThoseAbove) {
  const ProgramRun run = showHeadless("320x240");
  ASSERT_EQ(run.exitCode, 0) << run.err;
  expectFoamAndItems(imageOf("out/window.png"), foamOverGradient());

  std::filesystem::rename(folder_ / "out/window.png", folder_ / "before.png");
  const ProgramRun again = showHeadless("320x240", {"--compare", "before.png", "--min-psnr", "60"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  frothWell({"render", "random.froth", "--cameras", "cameras.json", "--view", "0", "--renderer", "reference", "-o",
             "alone.png"});
  const ProgramRun other = showHeadless("320x240", {"--compare", "alone.png", "--min-psnr", "40"});
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_THAT(other.err, HasSubstr("below --min-psnr 40"));
}

TEST_F(QtQuick, FollowsTheSizeOfItsWindow) {
  const Image expected = foamOverGradient();
  for (const char* before : {"200x150", "500x400"}) {
    const ProgramRun run = showHeadless(before, {"--resize", "320x240"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    expectFoamAndItems(imageOf("out/window.png"), expected);
  }
}

TEST_F(QtQuick, DrawsOnTheThreadOfTheWindowToo) {
  setenv("QSG_RENDER_LOOP", "basic", 1);
  const ProgramRun run = showHeadless("320x240");
  unsetenv("QSG_RENDER_LOOP");
  ASSERT_EQ(run.exitCode, 0) << run.err;
  expectFoamAndItems(imageOf("out/window.png"), foamOverGradient());
}

TEST_F(QtQuick, EndsWhileFramesAreInFlight) {
  const ProgramRun run = show({"random.froth", "--frames", "2", "--size", "320x240", "--validate"});
  EXPECT_EQ(run.exitCode, 0) << run.err;
}

TEST_F(QtQuick, TellsWhatIsWrongWithTheFileAndTheArguments) {
  writeBytes(folder_ / "broken.froth", readBytes(folder_ / "random.froth").substr(0, 1000));
  const ProgramRun broken = show({"broken.froth", "--validate"});
  EXPECT_EQ(broken.exitCode, 3);
  EXPECT_THAT(broken.err, HasSubstr("broken.froth"));
  EXPECT_EQ(show({"random.froth", "--headless"}).exitCode, 2);
  EXPECT_EQ(showHeadless("320x240", {"--resize", "wide"}).exitCode, 2);
}

TEST_F(QtQuick, SaysWhatToDoWithoutADisplay) {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) unsetenv(variable);
  const ProgramRun run = runProgram(FROTH_QT_QUICK, {"random.froth"}, folder_);
  EXPECT_EQ(run.exitCode, 1);
  EXPECT_THAT(run.err, HasSubstr("xvfb-run"));
}

}  // namespace
}  // namespace froth::test
