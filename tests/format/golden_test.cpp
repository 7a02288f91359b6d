// Files that earlier versions wrote stay readable. The golden file is written again by
//   FROTH_WRITE_GOLDEN=1 test_format --gtest_filter='Golden.*'
// only when a new major version makes the old one unreadable on purpose.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "asset_equality.h"
#include "format/asset_reader.h"
#include "format/asset_writer.h"
#include "sample_asset.h"

namespace froth {
namespace {

TEST(Golden, FileOfVersion1IsRead) {
  const std::filesystem::path path =
      std::filesystem::path(FROTH_SOURCE_DIR) / "tests/format/golden/version_1_0.froth";
  const AssetContents contents = makeSampleAsset({.chunkCount = 2, .cellsPerChunk = 6, .localBits = 4});
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

}  // namespace
}  // namespace froth
