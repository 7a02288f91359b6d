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

// Counts and raw sizes agree, two billion cells each; only the file's size speaks against them.
TEST(Allocation, OfConsistentButAbsurdCountsDoesNotHappen) {
  constexpr uint64_t kCells = 0x7fffffff;
  Draft draft = draftOf(makeSampleAsset({.detailCount = 32, .lobeCount = 32}));
  draft.chunks[0].counts = {kCells, kCells, 0, kCells, kCells * 32 * 32};
  for (SectionRecord& record : draft.records) {
    const SectionType type = static_cast<SectionType>(record.type);
    if (sectionKind(type, draft.contents.quantization) == ElementKind::kGraph) record.elementSize = 4;
    record.codec = static_cast<uint16_t>(SectionCodec::kZstd);
    record.rawSize = sectionEntries(type, draft.chunks[0].counts, 32) *
                     sectionComponents(type, draft.contents.quantization) * record.elementSize;
  }
  std::string error;
  EXPECT_LT(largestAllocationOf(draft.assemble(), error), size_t{1} << 20);
  EXPECT_THAT(error, testing::HasSubstr("cannot hold"));
}

// A codebook of the largest size, of which the file has no trace.
TEST(Allocation, OfACodebookThatIsNotThereDoesNotHappen) {
  Draft draft = draftOf(makeSampleAsset({.isQuantized = true, .codebookSize = 3}));
  draft.contents.axisCodebook.resize(65536);
  std::string error;
  EXPECT_LT(largestAllocationOf(draft.assemble(), error), size_t{1} << 16);
  EXPECT_THAT(error, testing::HasSubstr(
                         "shared, section 'axis_codebook': raw size 36, but the counts demand 786432 bytes"));
}

TEST(Allocation, StaysWithinTheFilesSizeTimesTheLimitOfExpansion) {
  for (const bool isQuantized : {false, true}) {
    const std::vector<uint8_t> bytes =
        encodeOrFail(makeSampleAsset({.cellsPerChunk = 100, .isQuantized = isQuantized, .hasLayers = true}));
    std::string error;
    EXPECT_LT(largestAllocationOf(bytes, error), bytes.size() * kMaxExpansion);
    EXPECT_EQ(error, "no error");
  }
}

}  // namespace
}  // namespace froth
