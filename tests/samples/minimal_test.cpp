// froth_minimal against the double reference, and how it fails.
#include <cmath>

#include <gmock/gmock.h>

#include "base/image/image.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using testing::HasSubstr;

class Minimal : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
    CameraSet cameras;
    cameras.views.push_back(viewOfRandomFoam(480, 320));
    ASSERT_TRUE(writeCameras(folder_ / "cameras.json", cameras));
    frothWell({"synth", "random", "--cells", "120", "-o", "random.pt"});
    frothWell({"bake", "random.pt", "--preset", "exact", "-o", "random.froth", "--cameras", "cameras.json"});
  }

  ProgramRun minimal(const std::vector<std::string>& arguments) const {
    return runProgram(FROTH_MINIMAL, arguments, folder_);
  }

  void convertToPpm(const char* from, const char* to) const {
    const Result<Image> image = readImage(folder_ / from);
    ASSERT_TRUE(image) << image.error().message;
    std::string bytes = "P6\n480 320\n255\n";
    for (const float value : image->values) bytes += static_cast<char>(std::lround(255 * value));
    writeBytes(folder_ / to, bytes);
  }
};

TEST_F(Minimal, ShowsWhatTheDoubleReferenceShows) {
  frothWell({"render", "random.froth", "--cameras", "cameras.json", "--view", "0", "--renderer", "reference",
             "--cutoff", "1e-3", "-o", "reference.png"});
  convertToPpm("reference.png", "reference.ppm");
  const ProgramRun run =
      minimal({"random.froth", "seen.ppm", "--frames", "3", "--compare", "reference.ppm", "--min-psnr", "55"});
  EXPECT_EQ(run.exitCode, 0) << run.out << run.err;
  std::string black = "P6\n480 320\n255\n";
  black.resize(black.size() + 480 * 320 * 3);
  writeBytes(folder_ / "black.ppm", black);
  EXPECT_EQ(
      minimal({"random.froth", "seen.ppm", "--frames", "1", "--compare", "black.ppm", "--min-psnr", "40"}).exitCode, 1);
}

TEST_F(Minimal, TellsWhatIsWrongWithTheFileAndTheArguments) {
  writeBytes(folder_ / "broken.froth", readBytes(folder_ / "random.froth").substr(0, 1000));
  const ProgramRun broken = minimal({"broken.froth", "seen.ppm"});
  EXPECT_EQ(broken.exitCode, 1);
  EXPECT_THAT(broken.err, HasSubstr("error FROTH_ERROR_FILE: broken.froth"));
  EXPECT_EQ(minimal({"missing.froth", "seen.ppm"}).exitCode, 1);
  EXPECT_EQ(minimal({"random.froth"}).exitCode, 2);
  EXPECT_EQ(minimal({"random.froth", "seen.ppm", "--frames", "0"}).exitCode, 2);
  EXPECT_EQ(minimal({"random.froth", "seen.ppm", "--sharper", "1"}).exitCode, 2);
}

}  // namespace
}  // namespace froth::test
