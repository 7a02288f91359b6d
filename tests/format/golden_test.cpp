// Files that earlier versions wrote stay readable, or are refused for a reason. The golden file is written
// again by
//   FROTH_WRITE_GOLDEN=1 test_format --gtest_filter='Golden.*'
// only when a new major version makes the old one unreadable on purpose.
#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "asset_equality.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "sample_asset.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

std::filesystem::path goldenPath(const char* name) { return test::sourceFolder() / "tests/format/golden" / name; }

TEST(Golden, FileOfVersion2IsRead) {
  const std::filesystem::path path = goldenPath("version_2_0.froth");
  AssetContents contents = makeSampleAsset(
      {.chunkCount = 2, .cellsPerChunk = 6, .localBits = 4, .isQuantized = true, .hasLayers = true, .codebookSize = 5});
  contents.eyes = {};  // the file is older than this field
  if (std::getenv("FROTH_WRITE_GOLDEN")) {
    const Status written = writeAsset(path, contents);
    ASSERT_TRUE(written) << written.error().message;
  }
  Result<AssetContents> found = readAsset(path);
  ASSERT_TRUE(found) << found.error().message;
  expectSameAsset(*found, contents);
  const Status verified = verifyAsset(path);
  EXPECT_TRUE(verified) << verified.error().message;
}

// No release wrote version 1, and nobody shall write a reader for it.
TEST(Golden, FileOfVersion1IsRefusedWithItsRemedy) {
  const Result<AssetContents> found = readAsset(goldenPath("version_1_0.froth"));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::kUnsupported);
  EXPECT_THAT(found.error().message,
              testing::AllOf(testing::HasSubstr("version_1_0.froth: format version 1.0, this program reads 2"),
                             testing::HasSubstr("bake the scene again")));
}

}  // namespace
}  // namespace froth
