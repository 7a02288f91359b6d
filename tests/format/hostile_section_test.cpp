// Sections whose hashes fit and whose content is wrong.
#include <algorithm>
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include "file_surgery.h"
#include "sample_asset.h"

namespace froth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string errorOf(const std::vector<uint8_t>& bytes) {
  Result<AssetContents> contents = decodeAsset(bytes);
  return contents ? "no error" : contents.error().message;
}

// The error that one changed array of the sample's only chunk leads to.
template <class Element, class Edit>
std::string errorWith(SectionType type, std::vector<Element> ChunkContents::*array, Edit edit) {
  Draft draft = draftOf(makeSampleAsset());
  std::vector<Element> changed = draft.contents.chunks[0].*array;
  edit(changed);
  draft.replace(type, rawBytes(changed));
  return errorOf(draft.assemble());
}

TEST(HostileSection, WithANumberThatIsNotFiniteIsRefusedByPlace) {
  const std::string error =
      errorWith(SectionType::kSites, &ChunkContents::sites, [](auto& sites) { sites[1].z = NAN; });
  EXPECT_THAT(error,
              AllOf(HasSubstr("scene.froth: chunk 0, section 'sites': number 5 is nan"), HasSubstr("bake")));
  EXPECT_THAT(errorWith(SectionType::kLobeAxes, &ChunkContents::lobeAxes,
                        [](auto& axes) { axes.back().x = -INFINITY; }),
              HasSubstr("section 'lobe_axes'"));
  EXPECT_THAT(
      errorWith(SectionType::kDetailHeights, &ChunkContents::detailHeights, [](auto& h) { h[0] = INFINITY; }),
      HasSubstr("section 'detail_heights'"));
}

TEST(HostileSection, WithARadiusOrDensityOutOfRangeIsRefused) {
  EXPECT_THAT(errorWith(SectionType::kRadii, &ChunkContents::radii, [](auto& radii) { radii[3] = 0; }),
              HasSubstr("cell 3 has radius 0, not > 0"));
  EXPECT_THAT(errorWith(SectionType::kDensities, &ChunkContents::densities,
                        [](auto& densities) { densities[1] = -2; }),
              HasSubstr("cell 1 has density -2, not >= 0"));
}

TEST(HostileSection, WithAReferenceToNoCellIsRefused) {
  EXPECT_THAT(
      errorWith(SectionType::kNeighbours, &ChunkContents::neighbours, [](auto& cells) { cells[4] = 6; }),
      HasSubstr("section 'neighbours': cell 6 of chunk 0 >= 6"));
}

TEST(HostileSection, WithAReferenceToNoChunkIsRefused) {
  Draft draft = draftOf(makeSampleAsset({.chunkCount = 3, .localBits = 3}));
  std::vector<CellRef> cells = draft.contents.chunks[0].neighbours;
  cells[0] = 3 << 3;
  draft.replace(SectionType::kNeighbours, rawBytes(cells));
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("section 'neighbours': chunk 3 >= 3"));
}

TEST(HostileSection, WithOffsetsThatAreNoRowsIsRefused) {
  const auto errorOfOffsets = [](auto edit) {
    return errorWith(SectionType::kNeighbourOffsets, &ChunkContents::neighbourOffsets, edit);
  };
  EXPECT_THAT(errorOfOffsets([](auto& offsets) { offsets[0] = 1; }), HasSubstr("starts with 1"));
  EXPECT_THAT(errorOfOffsets([](auto& offsets) { offsets.back() += 1; }), HasSubstr("ends with 31"));
  EXPECT_THAT(errorOfOffsets([](auto& offsets) { offsets[2] = ~0u; }), HasSubstr("must not fall"));
}

TEST(HostileSection, WithMoreAlphaNeighboursThanNeighboursIsRefused) {
  EXPECT_THAT(
      errorWith(SectionType::kAlphaCounts, &ChunkContents::alphaCounts, [](auto& counts) { counts[2] = 6; }),
      HasSubstr("cell 2: 6 alpha neighbours in a row of 5"));
}

// ---- Encoding ----

std::vector<uint8_t> frameOf(std::span<const uint8_t> raw) {
  std::vector<uint8_t> frame(ZSTD_compressBound(raw.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), 1));
  return frame;
}

// The sample, with the frame of its radii exchanged.
std::string errorWithRadiiFrame(const std::vector<uint8_t>& frame) {
  Draft draft = draftOf(makeSampleAsset());
  const size_t index = draft.find(SectionType::kRadii);
  draft.records[index].codec = static_cast<uint16_t>(SectionCodec::kZstd);
  draft.stored[index] = frame;
  return errorOf(draft.assemble());
}

std::vector<float> sampleRadii() {
  return makeSampleAsset().chunks[0].radii;
}

TEST(HostileSection, IsReadWithZerosAfterItsFrameAndRefusedWithOtherBytes) {
  std::vector<uint8_t> frame = frameOf(rawBytes(sampleRadii()));
  frame.resize(frame.size() + 20, 0);
  EXPECT_EQ(errorWithRadiiFrame(frame), "no error");
  frame.back() = 1;
  EXPECT_THAT(errorWithRadiiFrame(frame), HasSubstr("bytes after the zstd frame are not zero"));
}

TEST(HostileSection, IsRefusedIfItsFrameHoldsMoreOrLess) {
  std::vector<float> radii = sampleRadii();
  radii.push_back(1);
  EXPECT_THAT(errorWithRadiiFrame(frameOf(rawBytes(radii))),
              HasSubstr("the zstd frame holds 28 bytes, the manifest says 24"));
  radii.resize(3);
  EXPECT_THAT(errorWithRadiiFrame(frameOf(rawBytes(radii))), HasSubstr("holds 12 bytes"));
}

TEST(HostileSection, IsRefusedIfItsFrameIsCutOrNone) {
  std::vector<uint8_t> frame = frameOf(rawBytes(sampleRadii()));
  EXPECT_THAT(errorWithRadiiFrame({'n', 'o', ' ', 'f', 'r', 'a', 'm', 'e'}), HasSubstr("no zstd frame"));
  frame.pop_back();
  EXPECT_THAT(errorWithRadiiFrame(frame), HasSubstr("zstd"));
}

TEST(HostileSection, IsRefusedIfItExpandsBeyondTheLimit) {
  Draft draft = draftOf(makeSampleAsset({.cellsPerChunk = 300, .detailCount = 8, .lobeCount = 8}));
  const std::vector<uint8_t> zeros(draft.contents.chunks[0].lobeAxes.size() * sizeof(glm::vec3), 0);
  const size_t index = draft.find(SectionType::kLobeAxes);
  draft.records[index].codec = static_cast<uint16_t>(SectionCodec::kZstd);
  draft.stored[index] = frameOf(zeros);
  ASSERT_GT(zeros.size() / kMaxExpansion, draft.stored[index].size());
  EXPECT_THAT(errorOf(draft.assemble()), AllOf(HasSubstr("'lobe_axes'"), HasSubstr("cannot hold")));
  draft.stored[index].resize((zeros.size() + kMaxExpansion - 1) / kMaxExpansion, 0);
  EXPECT_EQ(errorOf(draft.assemble()), "no error");
}

// Byte planes are taken in pieces, so zstd needs a window, and the frame must not choose its size freely.
TEST(HostileSection, IsRefusedIfItsFrameWantsALargeWindow) {
  const auto errorWithWindow = [](int windowLog) {
    Draft draft = draftOf(makeSampleAsset());
    const size_t index = draft.find(SectionType::kRadii);
    // Magic; 4-byte content size; window; content size 24; last block, raw, of 24 bytes (RFC 8878, 3.1.1).
    const std::array<uint8_t, 12> head = {
        0x28, 0xb5, 0x2f, 0xfd, 0x80,          static_cast<uint8_t>((windowLog - 10) << 3),
        24,   0,    0,    0,    (24 << 3) | 1, 0};
    std::vector<uint8_t> frame(head.size() + 1 + 24, 0x3f);
    std::copy(head.begin(), head.end(), frame.begin());
    frame[head.size()] = 0;
    draft.records[index].codec = static_cast<uint16_t>(SectionCodec::kBytePlanes);
    draft.stored[index] = frame;
    return errorOf(draft.assemble());
  };
  EXPECT_EQ(errorWithWindow(kMaxWindowLog), "no error");
  EXPECT_THAT(errorWithWindow(kMaxWindowLog + 1), HasSubstr("too much memory"));
}

}  // namespace
}  // namespace froth
