// What `froth bench --open` tells, and what it and --flight refuse.
#include <gmock/gmock.h>

#include "tests/http/range_server.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class BenchOpen : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  }

  void makeGallery() const {
    frothWell({"synth", "gallery", "--cells", "5000", "-o", "gallery.pt"});
    frothWell({"bake", "gallery.pt", "--lod", "--chunk-cells", "512", "--no-measure", "-o", "gallery.froth"});
  }

  Json open(const std::string& asset, const std::string& cameras, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"bench", asset, "--cameras", cameras, "--size", "48x32", "--open", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return frothJson(arguments);
  }

  // Marks follow each other, and what a later one counts includes what an earlier one does.
  static void expectOrder(const Json& run) {
    const std::vector<std::string> marks{"head", "ready", "first", "settled"};
    for (size_t i = 1; i < marks.size(); ++i) {
      for (const char* figure : {"ms", "frames", "reads", "bytes", "processMs"}) {
        EXPECT_LE(run[marks[i - 1]][figure], run[marks[i]][figure]) << marks[i] << " " << figure;
      }
    }
    EXPECT_GT(run["head"]["ms"], 0);
  }
};

TEST_F(BenchOpen, ReadsTheFloorForTheFirstImageAndTheRestForTheSettledOne) {
  makeGallery();
  const Json figures = open("gallery.froth", "gallery.cameras.json");
  const auto size = std::filesystem::file_size(folder_ / "gallery.froth");
  ASSERT_EQ(figures["runs"].size(), 2u);
  for (const Json& run : figures["runs"]) {
    expectOrder(run);
    EXPECT_LT(run["ready"]["bytes"], size / 2) << "of the file";
    EXPECT_GT(run["settled"]["bytes"], run["ready"]["bytes"]);
    EXPECT_LE(run["settled"]["bytes"], size + (64 << 10)) << "nothing twice but chunks within the first 64 KiB";
    EXPECT_GE(run["cachedShare"], 0);
  }
  EXPECT_EQ(figures["firstMs"]["median"], figures["runs"][1]["first"]["ms"]);
}

TEST_F(BenchOpen, ReadsAllForTheFirstImageOfAnAssetWithoutLevels) {
  makeRandomFoam("200");
  const Json figures = open("random.froth", "cameras.json", {"--keep-cache"});
  for (const Json& run : figures["runs"]) {
    expectOrder(run);
    EXPECT_EQ(run["ready"]["bytes"], run["settled"]["bytes"]);
    EXPECT_EQ(run["cachedShare"], 1) << "it was just written";
  }
}

TEST_F(BenchOpen, OpensUrls) {
#ifndef FROTH_HAS_CURL
  FROTH_SKIP() << "no libcurl";
#endif
  makeRandomFoam("200");
  const RangeServer server(folder_);
  if (server.port() == 0) FROTH_SKIP() << "no python3";
  const Json figures = open(server.url("plain", "random.froth"), "cameras.json");
  for (const Json& run : figures["runs"]) {
    expectOrder(run);
    EXPECT_EQ(run["cachedShare"], nullptr);
  }
  const ProgramRun run =
      froth({"bench", server.url("plain", "none.froth"), "--cameras", "cameras.json", "--open", "1"});
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_THAT(run.err, HasSubstr("404"));
}

TEST_F(BenchOpen, RefusesWhatItWouldIgnore) {
  for (const char* mode : {"--open", "--flight"}) {
    for (const char* other : {"--frames", "--warmup", "--layers"}) {
      const char* value = std::string(other) == "--frames" ? "100" : std::string(other) == "--warmup" ? "1s" : "2";
      const ProgramRun run = froth({"bench", "a.froth", "--cameras", "c.json", mode, "2", other, value});
      EXPECT_EQ(run.exitCode, 2);
      EXPECT_THAT(run.err, AllOf(HasSubstr(mode), HasSubstr(other)));
    }
  }
}

}  // namespace
}  // namespace froth::test
