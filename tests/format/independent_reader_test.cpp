// A reader in Python, written from docs/FORMAT.md alone, finds the same arrays as this library, bit for bit.
// FROTH_ASSETS: a folder of further assets to compare.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "asset_dump.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "level_sample.h"
#include "sample_asset.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

constexpr int kLeftOut = 77;  // a package is missing, or the asset has Draco sections

class IndependentReader : public testing::Test {
 protected:
  IndependentReader() {
    std::string pattern = (std::filesystem::temp_directory_path() / "froth_reader_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~IndependentReader() override { std::filesystem::remove_all(folder_); }

  // GTEST_SKIP and ASSERT leave the function; callers are done afterwards.
  void expectSame(const std::filesystem::path& asset) {
    for (const Layer last : {Layer::kGeometry, Layer::kDetails, Layer::kViewDependence}) {
      const Result<AssetContents> contents = readAsset(asset, last);
      ASSERT_TRUE(contents) << contents.error().message;
      writeDump(folder_ / "dump", *contents);
      const std::string layer = std::to_string(static_cast<int>(last));
      const std::string command = "/usr/bin/python3 -B '" +
                                  (test::sourceFolder() / "tests/format/compare_asset.py").string() + "' '" +
                                  asset.string() + "' --layer " + layer + " --compare '" + (folder_ / "dump").string() +
                                  "' >'" + (folder_ / "out").string() + "' 2>&1";
      const int status = std::system(command.c_str());
      if (WEXITSTATUS(status) == kLeftOut) FROTH_SKIP() << lastLines();
      EXPECT_EQ(status, 0) << asset << ", layer " << layer << ": " << lastLines();
    }
  }

  void expectSame(const SampleOptions& options) { expectSame(makeSampleAsset(options)); }

  void expectSame(const AssetContents& contents) {
    const std::filesystem::path asset = folder_ / "sample.froth";
    const Status written = writeAsset(asset, contents);
    ASSERT_TRUE(written) << written.error().message;
    expectSame(asset);
  }

 private:
  std::string lastLines() const {
    constexpr size_t kShown = 2000;
    std::ifstream file(folder_ / "out");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return text.substr(text.size() - std::min(text.size(), kShown));
  }

  std::filesystem::path folder_;
};

TEST_F(IndependentReader, AgreesOnAnExactAsset) { expectSame(SampleOptions{.cellsPerChunk = 40}); }

TEST_F(IndependentReader, AgreesWithoutWhatAnAssetNeedNotHave) {
  expectSame(SampleOptions{.cellsPerChunk = 40, .lobeCount = 0, .hasHeights = false, .hasWalkGraph = false});
}

TEST_F(IndependentReader, AgreesOnLatticesAndLayers) {
  expectSame(SampleOptions{.cellsPerChunk = 40, .isQuantized = true, .hasLayers = true});
}

TEST_F(IndependentReader, AgreesOnChunksWithGhostsAndACodebook) {
  expectSame(SampleOptions{
      .chunkCount = 3, .cellsPerChunk = 30, .localBits = 8, .isQuantized = true, .hasLayers = true, .codebookSize = 7});
}

TEST_F(IndependentReader, AgreesOnExactChunksWithoutWalkGraph) {
  expectSame(SampleOptions{.chunkCount = 2, .cellsPerChunk = 30, .localBits = 6, .hasWalkGraph = false});
}

TEST_F(IndependentReader, AgreesOnLevels) { expectSame(makeLevelSample()); }

TEST_F(IndependentReader, AgreesOnTheGoldenFiles) {
  expectSame(test::sourceFolder() / "tests/format/golden/version_2_0.froth");
  expectSame(test::sourceFolder() / "tests/format/golden/version_3_0.froth");
}

TEST_F(IndependentReader, AgreesOnBakedAssets) {
  const char* folder = std::getenv("FROTH_ASSETS");
  if (!folder) GTEST_SKIP() << "FROTH_ASSETS names no folder of assets";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".froth") expectSame(entry.path());
  }
}

}  // namespace
}  // namespace froth
