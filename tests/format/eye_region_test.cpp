// The eyes that an asset was baked for.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "asset_equality.h"
#include "file_surgery.h"
#include "sample_asset.h"

namespace froth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

AssetContents smallAsset() { return makeSampleAsset({.cellsPerChunk = 3, .detailCount = 1, .lobeCount = 1}); }

TEST(EyeRegions, SurviveARoundTrip) {
  const AssetContents contents = smallAsset();
  ASSERT_EQ(contents.eyes.boxes.size(), 2u);
  const Result<AssetContents> found = decodeAsset(encodeOrFail(contents));
  ASSERT_TRUE(found) << found.error().message;
  expectSameEyes(found->eyes, contents.eyes);
}

TEST(EyeRegions, MayBeUnknown) {
  AssetContents contents = smallAsset();
  contents.eyes = {};
  const Result<AssetContents> found = decodeAsset(encodeOrFail(contents));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->eyes.boxes.empty());
}

TEST(EyeRegions, OutOfRangeAreRefusedByTheirNames) {
  const Draft draft = draftOf(smallAsset());
  const auto errorWith = [&](void (*edit)(EyeRegion&)) {
    Draft changed = draft;
    edit(changed.contents.eyes);
    const Result<AssetContents> contents = decodeAsset(changed.assemble());
    return contents ? "no error" : contents.error().message;
  };
  EXPECT_EQ(errorWith([](EyeRegion&) {}), "no error");
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.boxes[0].min[1] = 3; }), HasSubstr("eyes: 3..2 is no interval"));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.boxes[1].max[2] = INFINITY; }), HasSubstr("eyes: 6..inf"));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.boxes[1].min[0] = NAN; }), HasSubstr("eyes: nan"));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.boxes[0].max[0] = 1e300; }),
              AllOf(HasSubstr("eyes: -1..1e+300"), HasSubstr("within +-2^50")));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.radius = -1; }), HasSubstr("eyes: radius is -1"));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.radius = NAN; }), HasSubstr("eyes: radius is nan"));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.radius = 1e16; }), HasSubstr("eyes: radius is 1e+16"));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.worstPsnr = INFINITY; }), HasSubstr("eyes: worst_psnr is inf"));
  EXPECT_THAT(errorWith([](EyeRegion& e) { e.meanPsnr = -2; }), HasSubstr("eyes: mean_psnr is -2"));
}

// Only a foreign writer makes such a table.
TEST(EyeRegions, WithoutABoxAreRefused) {
  std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  const auto* boxes = fb::GetManifest(bytes.data() + sizeof(FileHeader))->eyes()->boxes();
  const ptrdiff_t count = reinterpret_cast<const uint8_t*>(boxes) - bytes.data();  // a vector begins with it
  std::fill_n(bytes.begin() + count, sizeof(flatbuffers::uoffset_t), uint8_t{0});
  const Result<AssetContents> contents = decodeAsset(signedAgain(bytes));
  ASSERT_FALSE(contents);
  EXPECT_THAT(contents.error().message, HasSubstr("eyes: no box"));
}

}  // namespace
}  // namespace froth
