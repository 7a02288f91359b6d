// Files that earlier versions wrote stay readable, or are refused for a reason. A golden file is written by
//   FROTH_WRITE_GOLDEN=1 test_format --gtest_filter='Golden.FileOfVersion3*'
// once, when its version is new.
#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "asset_equality.h"
#include "base/atomic_file.h"
#include "file_surgery.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "level_sample.h"
#include "sample_asset.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

std::filesystem::path goldenPath(const char* name) { return test::sourceFolder() / "tests/format/golden" / name; }

AssetContents contentsOfVersion2() {
  AssetContents contents = makeSampleAsset(
      {.chunkCount = 2, .cellsPerChunk = 6, .localBits = 4, .isQuantized = true, .hasLayers = true, .codebookSize = 5});
  contents.eyes = {};  // the file is older than this field
  return contents;
}

AssetContents contentsOfVersion3() { return makeLevelSample({.cellCount = 60}); }

void expectGolden(const std::filesystem::path& path, const AssetContents& contents) {
  Result<AssetContents> found = readAsset(path);
  ASSERT_TRUE(found) << found.error().message;
  expectSameAsset(*found, contents);
  const Status verified = verifyAsset(path);
  EXPECT_TRUE(verified) << verified.error().message;
}

TEST(Golden, FileOfVersion2IsRead) { expectGolden(goldenPath("version_2_0.froth"), contentsOfVersion2()); }

TEST(Golden, FileOfVersion3IsRead) {
  if (std::getenv("FROTH_WRITE_GOLDEN")) {
    const Status written = writeAsset(goldenPath("version_3_0.froth"), contentsOfVersion3());
    ASSERT_TRUE(written) << written.error().message;
  }
  expectGolden(goldenPath("version_3_0.froth"), contentsOfVersion3());
}

// Holds for the versions of zstd and Draco that the file was written with (Debian 12's).
TEST(Golden, AnAssetWithoutLevelsDiffersFromVersion2ByTheVersionAlone) {
  const std::vector<uint8_t> written = encodeOrFail(contentsOfVersion2());
  const std::vector<uint8_t> old = withHeader(written, [](FileHeader& header) { header.versionMajor = 2; });
  const Result<std::vector<uint8_t>> golden = readFile(goldenPath("version_2_0.froth"));
  ASSERT_TRUE(golden);
  EXPECT_EQ(old, *golden);
}

// No release wrote version 1, and nobody shall write a reader for it.
TEST(Golden, FileOfVersion1IsRefusedWithItsRemedy) {
  const Result<AssetContents> found = readAsset(goldenPath("version_1_0.froth"));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::kUnsupported);
  EXPECT_THAT(found.error().message,
              testing::AllOf(testing::HasSubstr("version_1_0.froth: format version 1.0, this program reads 2 and 3"),
                             testing::HasSubstr("bake the scene again")));
}

}  // namespace
}  // namespace froth
