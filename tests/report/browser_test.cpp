// Opens report.html in headless Chromium. What it made stays in the build folder: report.html, report.png,
// report_dark.png.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/image/image.h"
#include "measure/report/report.h"
#include "tests/report/sample_report.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = FROTH_TEST_OUTPUT;

std::string readText(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// What the page wrote to its console, and a line for each load over the network that it began. No host can be
// reached.
std::string openPage(const fs::path& page, const fs::path& picture, int height, const std::string& options = "") {
  const std::string name = picture.stem().string();  // tests may run side by side
  const fs::path log = kFolder / (name + ".log"), profile = kFolder / (name + "_profile");
  const fs::path loads = profile / "loads.json";
  const std::string command =
      "chromium --headless=new --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
      "--disable-component-update --host-resolver-rules='MAP * ~NOTFOUND' --hide-scrollbars "
      "--virtual-time-budget=5000 --enable-logging=stderr --v=0 " +
      options + " --log-net-log='" + loads.string() + "' --user-data-dir='" + profile.string() +
      "' --window-size=1200," + std::to_string(height) + " --screenshot='" + picture.string() + "' 'file://" +
      page.string() + "' > '" + log.string() + "' 2>&1";
  fs::remove(picture);
  fs::create_directories(profile);
  EXPECT_EQ(std::system(command.c_str()), 0) << readText(log);
  std::istringstream lines(readText(log));
  std::string console;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("CONSOLE") != std::string::npos) console += line + "\n";
  }
  // What the browser loads for itself has no page that began it.
  const std::string requests = readText(loads), begun = "\"initiator\":\"";
  for (size_t at = requests.find(begun); at != std::string::npos; at = requests.find(begun, at + 1)) {
    if (requests.compare(at + begun.size(), 13, "not an origin") != 0) console += requests.substr(at, 400) + "\n";
  }
  EXPECT_FALSE(requests.empty());
  fs::remove_all(profile);
  return console;
}

fs::path writePage(const char* name, const std::string& html) {
  const fs::path path = kFolder / name;
  std::ofstream(path, std::ios::binary) << html;
  return path;
}

class Browser : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium > /dev/null") != 0) FROTH_SKIP() << "chromium is not installed";
  }
};

// Share of pixels in [from, to) rows that have not the colour of the first.
double drawnShare(const Image& image, uint32_t from, uint32_t to) {
  size_t drawn = 0;
  for (uint32_t y = from; y < to; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      drawn += !std::equal(image.pixel(x, y), image.pixel(x, y) + 3, image.pixel(0, 0));
    }
  }
  return double(drawn) / (double(to - from) * image.width);
}

size_t pixelsOf(const Image& image, int red, int green, int blue) {
  size_t count = 0;
  for (size_t i = 0; i < image.values.size(); i += 3) {
    count += std::lround(image.values[i] * 255) == red && std::lround(image.values[i + 1] * 255) == green &&
             std::lround(image.values[i + 2] * 255) == blue;
  }
  return count;
}

TEST_F(Browser, ShowsTheReportWithoutAWordOnTheConsole) {
  const fs::path page = writePage("report.html", reportAsHtml(test::makeSampleReport())),
                 picture = kFolder / "report.png";
  EXPECT_EQ(openPage(page, picture, 13000), "");
  const Result<Image> image = readImage(picture);
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, 1200u);
  for (uint32_t y = 0; y + 1000 <= 12000; y += 1000) {
    EXPECT_GT(drawnShare(*image, y, y + 1000), 0.01) << "from row " << y;
  }
  // Markers and lines of the first two series.
  EXPECT_GT(pixelsOf(*image, 0x0b, 0x63, 0xce), 5000u);
  EXPECT_GT(pixelsOf(*image, 0xc2, 0x41, 0x0c), 5000u);
}

TEST_F(Browser, ShowsItOnDarkPaperToo) {
  const fs::path page = writePage("report_dark.html", reportAsHtml(test::makeSampleReport())),
                 picture = kFolder / "report_dark.png";
  EXPECT_EQ(openPage(page, picture, 2400, "--blink-settings=preferredColorScheme=0"), "");
  const Result<Image> image = readImage(picture);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_LT(image->pixel(0, 0)[0], 0.15f);
  EXPECT_GT(drawnShare(*image, 0, 2400), 0.02);
  EXPECT_GT(pixelsOf(*image, 0x6c, 0xb0, 0xff), 500u);
}

TEST_F(Browser, ShowsATrainingRun) {
  const fs::path page = writePage("training.html", trainingAsHtml(test::makeSampleTraining(1))),
                 picture = kFolder / "training.png";
  EXPECT_EQ(openPage(page, picture, 1000), "");
  const Result<Image> image = readImage(picture);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_GT(pixelsOf(*image, 0x0b, 0x63, 0xce), 500u);  // the curves
  EXPECT_GT(drawnShare(*image, 600, 750), 0.5);         // the photos
}

// The checks above can fail: errors and loads from elsewhere are seen.
TEST_F(Browser, WouldHaveShownErrorsAndLoads) {
  const fs::path picture = kFolder / "planted.png";
  EXPECT_NE(
      openPage(writePage("planted.html", "<!doctype html><script>console.error('planted')</script>"), picture, 200)
          .find("planted"),
      std::string::npos);
  EXPECT_NE(openPage(writePage("planted.html", "<!doctype html><img src='http://example.org/a.png'>"), picture, 200)
                .find("example.org"),
            std::string::npos);
}

}  // namespace
}  // namespace froth
