// That a file's promises do not make the reader allocate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "file_surgery.h"
#include "sample_asset.h"

namespace froth {
namespace {

// Decodes and tells the largest allocation on the way.
size_t largestAllocationOf(const std::vector<uint8_t>& bytes, std::string& error) {
  forgetAllocations();
  const Result<AssetContents> contents = decodeAsset(bytes);
  const size_t largest = largestAllocation();
  error = contents ? "no error" : contents.error().message;
  return largest;
}

// Counts and raw sizes agree, four billion cells each; only the file's size speaks against them.
TEST(Allocation, OfConsistentButAbsurdCountsDoesNotHappen) {
  constexpr uint64_t kCells = 0xffffffff;
  std::vector<uint8_t> bytes = encodeOrFail(makeSampleAsset({.detailCount = 32, .lobeCount = 32}));
  const ChunkCounts counts{kCells, kCells, kCells};
  bytes = withChunk(bytes,
                    [](fb::Chunk& c) { c = fb::Chunk(c.origin(), kCells, kCells, kCells, c.live_bounds()); });
  for (size_t i = 0; i < 11; ++i)
    bytes = withSection(bytes, i, [&](fb::Section& s) {
      const uint64_t words = sectionWords(static_cast<SectionType>(s.type()), counts, 32, 32);
      s = fb::Section(s.type(), s.chunk(), s.flags(), 1, 0, s.offset(), s.stored_size(), words * kWordSize,
                      s.hash());
    });
  std::string error;
  EXPECT_LT(largestAllocationOf(bytes, error), size_t{1} << 20);
  EXPECT_THAT(error, testing::HasSubstr("cannot hold"));
}

TEST(Allocation, StaysWithinTheFilesSizeTimesTheLimitOfExpansion) {
  const std::vector<uint8_t> bytes = encodeOrFail(makeSampleAsset({.cellsPerChunk = 100}));
  std::string error;
  EXPECT_LT(largestAllocationOf(bytes, error), bytes.size() * kMaxExpansion);
  EXPECT_EQ(error, "no error");
}

}  // namespace
}  // namespace froth
