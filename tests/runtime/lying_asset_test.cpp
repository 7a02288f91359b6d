// Files whose hashes fit and whose chunks tell what is not so: what the runtime sees of it without `froth verify`.
#include "runtime_fixture.h"
#include "tests/format/file_surgery.h"

namespace froth {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class LyingAsset : public RuntimeTest {
 protected:
  void SetUp() override { createContext(); }

  void expectRefused(FrothAsset asset) {
    EXPECT_EQ(update(1), FROTH_OK);
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
    EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_FILE);
    ASSERT_EQ(messages_.size(), 1u);
  }
};

TEST_F(LyingAsset, WithFalseBoundsFails) {
  Draft draft = draftOf(makeSampleAsset());
  draft.chunks[0].liveBounds.max[1] -= 0.5;
  expectRefused(openBytes(draft.assemble()));
  EXPECT_THAT(lastText(), AllOf(HasSubstr("chunk 0: live_bounds"), HasSubstr("along axis 1")));
}

TEST_F(LyingAsset, WithTwoNeighboursAtOnePointFails) {
  AssetContents contents = makeSampleAsset();
  contents.chunks[0].sites[1] = contents.chunks[0].sites[0];
  expectRefused(openBytes(*encodeAsset(contents)));
  EXPECT_THAT(lastText(), HasSubstr("the same point"));
}

// Only where the cells of all chunks are in host memory.
TEST_F(LyingAsset, WithAGhostThatIsNotItsCellFailsWhereItIsKeptForQueries) {
  AssetContents contents = makeSampleAsset({.chunkCount = 2, .localBits = 8});
  contents.chunks[1].radii.back() += 0x1p-9f;
  const std::vector<uint8_t> bytes = *encodeAsset(contents);
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes.data();
  info.dataSize = bytes.size();
  info.keepForQueries = 1;
  FrothAsset asset{};
  ASSERT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK);
  expectRefused(asset);
  EXPECT_THAT(lastText(), HasSubstr("chunk 1: ghost 5 is not where cell 5 of chunk 0 is"));
}

}  // namespace
}  // namespace froth
