// Sections whose hashes fit and whose content is wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include "file_surgery.h"
#include "format/read/frame_read.h"
#include "format/read/section_codec_read.h"
#include "sample_asset.h"

namespace froth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string errorOf(const std::vector<uint8_t>& bytes) {
  Result<AssetContents> contents = decodeAsset(bytes);
  return contents ? "no error" : contents.error().message;
}

// The error that one changed section of chunk 0 leads to.
template <class Element>
std::string errorWith(const AssetContents& contents, SectionType type, const std::vector<Element>& elements) {
  Draft draft = draftOf(contents);
  EXPECT_EQ(draft.records[draft.find(type)].rawSize, rawBytes(elements).size());
  draft.replace(type, rawBytes(elements));
  return errorOf(draft.assemble());
}

template <class Element>
std::vector<Element> elementsOf(const AssetContents& contents, SectionType type) {
  const Draft draft = draftOf(contents);
  const size_t index = draft.find(type);
  const SectionRecord& record = draft.records[index];
  EXPECT_EQ(record.elementSize, sizeof(Element));
  std::vector<Element> elements(record.rawSize / sizeof(Element));
  const std::span<uint8_t> raw{reinterpret_cast<uint8_t*>(elements.data()), record.rawSize};
  const uint32_t components = sectionComponents(type, contents.quantization);
  const Status status = decodeSection(record, draft.stored[index], raw, "section", {record.elementSize, components});
  EXPECT_TRUE(status) << status.error().message;
  return elements;
}

// The error that an edit of one section leads to.
template <class Element, class Edit>
std::string errorAfter(const AssetContents& contents, SectionType type, Edit edit) {
  std::vector<Element> elements = elementsOf<Element>(contents, type);
  edit(elements);
  return errorWith(contents, type, elements);
}

AssetContents quantizedAsset() {
  return makeSampleAsset(
      {.chunkCount = 2, .cellsPerChunk = 9, .localBits = 4, .isQuantized = true, .hasLayers = true, .codebookSize = 5});
}

TEST(HostileSection, WithANumberThatIsNotFiniteIsRefusedByPlace) {
  const AssetContents contents = makeSampleAsset();
  EXPECT_THAT(errorAfter<float>(contents, SectionType::kSites, [](auto& sites) { sites[5] = NAN; }),
              AllOf(HasSubstr("scene.froth: chunk 0: sites: number 5 is nan"), HasSubstr("bake")));
  EXPECT_THAT(errorAfter<float>(contents, SectionType::kLobeAxes, [](auto& axes) { axes.back() = -INFINITY; }),
              HasSubstr("lobe_axes"));
  EXPECT_THAT(errorAfter<float>(contents, SectionType::kDetailHeights, [](auto& h) { h[0] = INFINITY; }),
              HasSubstr("detail_heights"));
}

TEST(HostileSection, WithARadiusOrDensityOutOfRangeIsRefused) {
  const AssetContents contents = makeSampleAsset();
  EXPECT_THAT(errorAfter<float>(contents, SectionType::kRadii, [](auto& radii) { radii[3] = 0; }),
              HasSubstr("cell 3 has radius 0, not > 0"));
  EXPECT_THAT(errorAfter<float>(contents, SectionType::kDensities, [](auto& densities) { densities[1] = -2; }),
              HasSubstr("cell 1 has density -2, not +0 or more"));
  EXPECT_THAT(errorAfter<float>(contents, SectionType::kDensities, [](auto& densities) { densities[1] = -0.0f; }),
              HasSubstr("cell 1 has density -0, not +0 or more"));
}

TEST(HostileSection, WithANumberOutOfAllReasonIsRefused) {
  const AssetContents contents = makeSampleAsset({.hasLayers = true, .codebookSize = 3});
  const auto errorWithFirst = [&](SectionType type, float number) {
    return errorAfter<float>(contents, type, [&](auto& numbers) { numbers[0] = number; });
  };
  for (const SectionType type :
       {SectionType::kSites, SectionType::kRadii, SectionType::kCellHeights, SectionType::kDetailSites,
        SectionType::kDetailHeights, SectionType::kBaseColours, SectionType::kLobeColours}) {
    EXPECT_THAT(errorWithFirst(type, 1.2e15f), HasSubstr("number 0 is 1.2e+15, not within +-2^50"))
        << sectionName(static_cast<uint32_t>(type));
    EXPECT_EQ(errorWithFirst(type, 1e15f), "no error") << sectionName(static_cast<uint32_t>(type));
  }
  EXPECT_THAT(errorWithFirst(SectionType::kDensities, 3e38f), HasSubstr("number 0 is 3e+38, not within +-2^100"));
  EXPECT_EQ(errorWithFirst(SectionType::kDensities, 1e30f), "no error");
  Draft draft = draftOf(contents);
  const size_t codebook = draft.find(SectionType::kAxisCodebook, kSharedChunk);
  std::vector<glm::vec3> axes = contents.axisCodebook;
  axes[1].y = 3e38f;
  const std::span<const uint8_t> raw = rawBytes(axes);
  draft.records[codebook].codec = 0;
  draft.records[codebook].rawSize = raw.size();
  draft.stored[codebook].assign(raw.begin(), raw.end());
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("axis codebook holds 3e+38"));
}

TEST(HostileSection, WithAFrameThatIsNoRotationIsRefused) {
  const AssetContents contents = makeSampleAsset();
  for (const float length : {0.0f, 1e-20f, 0.99f, 1.001f, 2.0f, 1e14f}) {
    EXPECT_THAT(errorAfter<float>(contents, SectionType::kOrientations,
                                  [&](auto& numbers) {
                                    for (size_t i = 8; i < 12; ++i) numbers[i] = i == 8 ? length : 0;
                                  }),
                AllOf(HasSubstr("section 'orientations': cell 2 has ("), HasSubstr("no unit quaternion")))
        << length;
  }
}

TEST(HostileSection, WithAGhostThatLivesNowhereIsRefused) {
  const auto errorWithGhost = [](size_t ghost, CellRef ref) {
    return errorAfter<CellRef>(quantizedAsset(), SectionType::kGhostRefs, [&](auto& refs) { refs[ghost] = ref; });
  };
  EXPECT_THAT(errorWithGhost(8, 2 << 4),
              HasSubstr("section 'ghost_refs': a ghost lives in cell 0 of chunk 2, which is not there"));
  EXPECT_THAT(errorWithGhost(8, (1 << 4) + 9), HasSubstr("cell 9 of chunk 1, which is not there"));
  EXPECT_THAT(errorWithGhost(0, 3), HasSubstr("cell 3 of chunk 0, which is its own"));
  EXPECT_THAT(errorWithGhost(3, 1 << 4), HasSubstr("references must ascend"));
}

TEST(HostileSection, WithAGraphThatLeavesItsChunkIsRefused) {
  const AssetContents contents = quantizedAsset();
  EXPECT_THAT(errorAfter<uint16_t>(contents, SectionType::kGraphDeltas, [](auto& deltas) { deltas[0] = 18; }),
              HasSubstr("neighbour"));
  EXPECT_THAT(errorAfter<uint16_t>(contents, SectionType::kGraphCounts, [](auto& counts) { ++counts[0]; }),
              HasSubstr("graph"));
}

TEST(HostileSection, WithAnIndexOffItsLatticeIsRefused) {
  const AssetContents contents = quantizedAsset();
  const auto errorOfSites = [&](int32_t index) {
    return errorAfter<int32_t>(contents, SectionType::kSites, [&](auto& sites) { sites[4] = index; });
  };
  EXPECT_THAT(errorOfSites(1 << 24), HasSubstr("section 'sites': number 4 is out of range"));
  EXPECT_THAT(errorOfSites(-(1 << 24)), HasSubstr("out of range"));
  EXPECT_THAT(errorOfSites(std::numeric_limits<int32_t>::min()), HasSubstr("out of range"));
  EXPECT_EQ(errorOfSites((1 << 24) - 1), "no error");
  EXPECT_THAT(errorAfter<uint16_t>(contents, SectionType::kOrientations, [](auto& normals) { normals[3] = 511; }),
              HasSubstr("section 'orientations': number 2 is out of range"));
  EXPECT_THAT(errorAfter<uint8_t>(contents, SectionType::kColourScales, [](auto& scales) { scales[2] = 16; }),
              HasSubstr("section 'colour_scales': number 2 is out of range"));
  EXPECT_THAT(errorAfter<uint8_t>(contents, SectionType::kDetailScales, [](auto& scales) { scales[1] = 16; }),
              HasSubstr("section 'detail_scales': number 1 is out of range"));
  EXPECT_THAT(errorAfter<uint8_t>(contents, SectionType::kSolidBalls, [](auto& balls) { balls[6] = 65; }),
              AllOf(HasSubstr("section 'solid_balls': cell 1 has bytes"), HasSubstr("more than 64")));
  EXPECT_THAT(errorAfter<uint8_t>(contents, SectionType::kLobeLabels, [](auto& labels) { labels[1] = 5; }),
              HasSubstr("section 'lobe_labels': number 1 is out of range"));
}

// The base is no part of the section, but of its record.
TEST(HostileSection, WithABaseThatMakesItsNumbersAbsurdIsRefused) {
  for (const auto& [type, base] :
       {std::pair{SectionType::kRadii, 255u << 9}, std::pair{SectionType::kRadii, ~0u},
        std::pair{SectionType::kOrientations, 511u}, std::pair{SectionType::kLobeLabels, 5u}}) {
    Draft draft = draftOf(quantizedAsset());
    draft.records[draft.find(type)].base = base;
    EXPECT_NE(errorOf(draft.assemble()), "no error") << sectionName(static_cast<uint32_t>(type)) << " + " << base;
  }
}

TEST(HostileSection, WithLobeCountsThatAddUpToAnotherNumberIsRefused) {
  const AssetContents contents = quantizedAsset();
  EXPECT_THAT(errorAfter<uint8_t>(contents, SectionType::kLobeCounts, [](auto& counts) { ++counts[1]; }),
              HasSubstr("section 'lobe_counts'"));
  EXPECT_THAT(errorAfter<uint8_t>(contents, SectionType::kLobeCounts,
                                  [](auto& counts) {
                                    counts[0] = static_cast<uint8_t>(counts[0] + counts[1]);
                                    counts[1] = 0;
                                    counts[0] = static_cast<uint8_t>(counts[0] + counts[2]);
                                    counts[2] = 0;
                                  }),
              HasSubstr("lobes at a detail site, more than 2"));
}

TEST(HostileSection, WithACodebookThatIsNotFiniteIsRefused) {
  Draft draft = draftOf(quantizedAsset());
  std::vector<glm::vec3> codebook = draft.contents.axisCodebook;
  codebook[3].y = NAN;
  const size_t index = draft.find(SectionType::kAxisCodebook, kSharedChunk);
  draft.records[index].codec = static_cast<uint16_t>(SectionCodec::kStored);
  draft.stored[index].assign(rawBytes(codebook).begin(), rawBytes(codebook).end());
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("codebook holds nan"));
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

std::vector<float> sampleRadii() { return makeSampleAsset().chunks[0].radii; }

TEST(HostileSection, IsReadWithZerosAfterItsFrameAndRefusedWithOtherBytes) {
  std::vector<uint8_t> frame = frameOf(rawBytes(sampleRadii()));
  frame.resize(frame.size() + 20, 0);
  EXPECT_EQ(errorWithRadiiFrame(frame), "no error");
  frame.back() = 1;
  EXPECT_THAT(errorWithRadiiFrame(frame), HasSubstr("bytes after the last zstd frame are not zero"));
}

TEST(HostileSection, IsRefusedIfItsFrameHoldsMoreOrLess) {
  std::vector<float> radii = sampleRadii();
  radii.push_back(1);
  EXPECT_THAT(errorWithRadiiFrame(frameOf(rawBytes(radii))), HasSubstr("the zstd frame holds 28 bytes instead of 24"));
  radii.resize(3);
  EXPECT_THAT(errorWithRadiiFrame(frameOf(rawBytes(radii))), HasSubstr("holds 12 bytes"));
}

TEST(HostileSection, IsRefusedIfItsFrameIsCutOrNone) {
  std::vector<uint8_t> frame = frameOf(rawBytes(sampleRadii()));
  EXPECT_THAT(errorWithRadiiFrame({'n', 'o', ' ', 'f', 'r', 'a', 'm', 'e'}), HasSubstr("no zstd frame"));
  frame.pop_back();
  EXPECT_THAT(errorWithRadiiFrame(frame), HasSubstr("zstd"));
}

// zstd reads the frames of its versions before 0.8, too, and no limit of windows holds for them.
TEST(HostileSection, IsRefusedIfItsFrameIsOfAnOlderZstd) {
  const std::vector<float> radii = sampleRadii();
  const std::span<const uint8_t> raw = rawBytes(radii);
  const auto size = static_cast<uint8_t>(raw.size());
  // Magic of version 0.7, one segment, content size; a raw block; the end.
  std::vector<uint8_t> frame = {0x27, 0xb5, 0x2f, 0xfd, 0x20, size, 0x40, 0, size};
  frame.insert(frame.end(), raw.begin(), raw.end());
  frame.insert(frame.end(), {0xc0, 0, 0});
  EXPECT_THAT(errorWithRadiiFrame(frame), HasSubstr("no zstd frame"));
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

// Planes larger than the piece in which they are taken need a window, and the frame must not choose its size freely.
TEST(HostileSection, IsRefusedIfItsFrameWantsALargeWindow) {
  const auto errorWithWindow = [](int windowLog) {
    Draft draft = draftOf(makeSampleAsset({.cellsPerChunk = 1600, .detailCount = 8, .lobeCount = 8}));
    const auto lobes = static_cast<uint32_t>(draft.contents.chunks[0].lobeAxes.size());
    EXPECT_GT(lobes, 1u << 16);
    // One frame per plane. Magic; 4-byte content size; window; content size; last block, raw (RFC 8878, 3.1.1).
    std::vector<uint8_t> head = {0x28, 0xb5, 0x2f, 0xfd, 0x80, static_cast<uint8_t>((windowLog - 10) << 3)};
    for (int shift = 0; shift < 32; shift += 8) head.push_back(static_cast<uint8_t>(lobes >> shift));
    for (int shift = 0; shift < 24; shift += 8) head.push_back(static_cast<uint8_t>((lobes << 3 | 1) >> shift));
    std::vector<uint8_t> frames;
    for (size_t plane = 0; plane < sizeof(glm::vec3); ++plane) {
      frames.insert(frames.end(), head.begin(), head.end());
      frames.insert(frames.end(), lobes, 0x3f);
    }
    const size_t index = draft.find(SectionType::kLobeAxes);
    draft.records[index].codec = static_cast<uint16_t>(SectionCodec::kBytePlanes);
    draft.stored[index] = frames;
    return errorOf(draft.assemble());
  };
  EXPECT_EQ(errorWithWindow(kMaxWindowLog), "no error");
  EXPECT_THAT(errorWithWindow(kMaxWindowLog + 1), HasSubstr("too much memory"));
}

}  // namespace
}  // namespace froth
