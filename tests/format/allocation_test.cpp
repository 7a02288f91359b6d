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
  EXPECT_THAT(error,
              testing::HasSubstr("shared, section 'axis_codebook': raw size 36, but the counts demand 786432 bytes"));
}

// Names and units of all errors are one long string, which lies in the file once.
std::vector<uint8_t> withSharedStrings() {
  AssetContents contents = makeSampleAsset();
  contents.preset = std::string(100'000, 'x');
  contents.errors.assign(900, {"a", "b", 0, 0});
  std::vector<uint8_t> bytes = encodeOrFail(contents);
  const fb::Manifest& manifest = *fb::GetManifest(bytes.data() + sizeof(FileHeader));
  const auto* target = reinterpret_cast<const uint8_t*>(manifest.preset());
  for (const fb::AttributeError* error : *manifest.errors()) {
    for (const auto field : {fb::AttributeError::VT_NAME, fb::AttributeError::VT_UNIT}) {
      auto* place = const_cast<uint8_t*>(reinterpret_cast<const flatbuffers::Table*>(error)->GetAddressOf(field));
      flatbuffers::WriteScalar(place, static_cast<flatbuffers::uoffset_t>(target - place));
    }
  }
  return signedAgain(bytes);
}

TEST(Allocation, OfStringsThatShareTheirBytesDoesNotHappen) {
  const std::vector<uint8_t> bytes = withSharedStrings();
  std::string error;
  largestAllocationOf(bytes, error);
  EXPECT_LT(allocatedBytes(), 20 * bytes.size());
  EXPECT_THAT(error, testing::HasSubstr("the manifest's strings together are longer than its"));
}

// Two billion pairs' worth of work in ten thousand cells; the manifest's counts alone tell.
TEST(Allocation, OfACompleteGraphDoesNotHappen) {
  Draft draft = draftOf(makeSampleAsset({.cellsPerChunk = 100}));
  draft.chunks[0].counts.cells = draft.chunks[0].counts.live = 10'000;
  draft.chunks[0].counts.pairs = 10'000 * 9'999 / 2;
  std::string error;
  EXPECT_LT(largestAllocationOf(draft.assemble(), error), size_t{1} << 16);
  EXPECT_THAT(error, testing::HasSubstr("pair_count is 49995000, not in 0..3"));
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
