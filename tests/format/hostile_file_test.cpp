// Any bytes give contents or a named error.
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "asset_equality.h"
#include "base/text.h"
#include "file_surgery.h"
#include "format/read/asset_reader.h"
#include "sample_asset.h"

namespace froth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

AssetContents smallAsset() {
  return makeSampleAsset({.chunkCount = 2, .cellsPerChunk = 3, .localBits = 2, .detailCount = 1, .lobeCount = 1});
}

// Something of everything, on lattices.
AssetContents richAsset() {
  return makeSampleAsset(
      {.chunkCount = 2, .cellsPerChunk = 9, .localBits = 4, .isQuantized = true, .hasLayers = true, .codebookSize = 5});
}

std::string errorOf(std::span<const uint8_t> bytes) {
  Result<AssetContents> contents = decodeAsset(bytes);
  return contents ? "no error" : contents.error().message;
}

TEST(HostileFile, IsRefusedWhenTruncatedAtAnyLength) {
  for (const AssetContents& contents : {smallAsset(), richAsset()}) {
    const std::vector<uint8_t> bytes = encodeOrFail(contents);
    for (size_t length = 0; length < bytes.size(); ++length) {
      // An allocation of this very length, so that a sanitizer sees a read past its end.
      const std::vector<uint8_t> part(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(length));
      ASSERT_FALSE(decodeAsset(part)) << "cut to " << length << " of " << bytes.size() << " bytes";
    }
  }
}

TEST(HostileFile, IsRefusedWithAnAppendedByte) {
  std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  bytes.push_back(0);
  EXPECT_THAT(errorOf(bytes), AllOf(HasSubstr("scene.froth"), HasSubstr("its header says")));
}

// More than 10^4 bits in each of them.
TEST(HostileFile, GivesAnErrorOrTheSameContentsForEveryFlippedBit) {
  for (const AssetContents& contents : {smallAsset(), richAsset()}) {
    std::vector<uint8_t> bytes = encodeOrFail(contents);
    ASSERT_GE(bytes.size() * 8, 10'000u);
    for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
      const uint8_t mask = static_cast<uint8_t>(1u << (bit % 8));
      bytes[bit / 8] ^= mask;
      if (Result<AssetContents> found = decodeAsset(bytes)) {
        SCOPED_TRACE("bit " + std::to_string(bit));
        expectSameAsset(*found, contents);
      }
      bytes[bit / 8] ^= mask;
    }
  }
}

// An attacker's hashes fit, so every later check must hold alone. The sanitizers show a wrong read.
TEST(HostileFile, SurvivesEveryFlippedBitThatIsSignedAgain) {
  for (const AssetContents& contents : {smallAsset(), richAsset()}) {
    std::vector<uint8_t> bytes = encodeOrFail(contents);
    size_t refused = 0;
    for (size_t bit = sizeof(FileHeader) * 8; bit < bytes.size() * 8; ++bit) {
      const uint8_t mask = static_cast<uint8_t>(1u << (bit % 8));
      bytes[bit / 8] ^= mask;
      if (!decodeAsset(signedAgain(bytes))) ++refused;
      bytes[bit / 8] ^= mask;
    }
    EXPECT_GT(refused, 0u);
  }
}

TEST(HostileFile, SurvivesRandomBytesBehindAValidMagic) {
  std::mt19937 random(3);
  for (int round = 0; round < 1000; ++round) {
    std::vector<uint8_t> bytes(random() % 512);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    std::copy_n(kFileMagic.begin(), std::min(bytes.size(), kFileMagic.size()), bytes.begin());
    EXPECT_FALSE(decodeAsset(bytes));
  }
}

// ---- Header ----

TEST(HostileFile, IsRefusedWithoutItsMagic) {
  const std::vector<uint8_t> bytes =
      withHeader(encodeOrFail(smallAsset()), [](FileHeader& header) { header.magic[1] = 'f'; });
  EXPECT_THAT(errorOf(bytes), AllOf(HasSubstr("magic"), HasSubstr("no .froth asset")));
}

TEST(HostileFile, OfAnotherMajorVersionIsRefusedWithWhatToDo) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  EXPECT_THAT(errorOf(withHeader(bytes, [](FileHeader& header) { header.versionMajor = 4; })),
              HasSubstr("format version 4.0, this program reads 2 and 3; update this program"));
  EXPECT_THAT(errorOf(withHeader(bytes, [](FileHeader& header) { header.versionMajor = 1; })),
              HasSubstr("format version 1.0, this program reads 2 and 3; bake the scene again"));
}

TEST(HostileFile, OfANewerMinorVersionIsRead) {
  const std::vector<uint8_t> bytes =
      withHeader(encodeOrFail(smallAsset()), [](FileHeader& header) { header.versionMinor = 9; });
  EXPECT_EQ(errorOf(bytes), "no error");
}

TEST(HostileFile, IsRefusedWithReservedHeaderBytes) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  EXPECT_THAT(errorOf(withHeader(bytes, [](FileHeader& header) { header.reserved0 = 1; })), HasSubstr("reserved"));
  EXPECT_THAT(errorOf(withHeader(bytes, [](FileHeader& header) { header.reserved1 = 1; })), HasSubstr("reserved"));
}

TEST(HostileFile, IsRefusedWithAManifestOutsideTheFile) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  for (const uint64_t size : {uint64_t{bytes.size()}, uint64_t{1} << 40, std::numeric_limits<uint64_t>::max()}) {
    EXPECT_FALSE(decodeAsset(withHeader(bytes, [&](FileHeader& header) { header.manifestSize = size; })));
  }
  EXPECT_FALSE(decodeAsset(withHeader(bytes, [](FileHeader& header) { header.manifestOffset = ~uint64_t{0}; })));
}

// ---- Manifest ----

TEST(HostileFile, WithParametersOutOfRangeIsRefusedByTheirNames) {
  const Draft draft = draftOf(smallAsset());
  const auto errorWith = [&](void (*edit)(AssetContents&)) {
    Draft changed = draft;
    edit(changed.contents);
    return errorOf(changed.assemble());
  };
  EXPECT_THAT(errorWith([](AssetContents& c) { c.detailCount = 33; }), HasSubstr("detail_count is 33, not in 1..32"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.lobeCount = 33; }), HasSubstr("lobe_count is 33, not in 0..32"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.lobeCount = 0; }), HasSubstr("chunk 0: lobe_count is 2, not in 0..0"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.localBits = 33; }), HasSubstr("local_bits is 33"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.localBits = 1; }), HasSubstr("cell_count is 3"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.localBits = 32; }), HasSubstr("number of chunks is 2"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.nearRatio = NAN; }), HasSubstr("near_ratio"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.nearDepth = -1; }), HasSubstr("near_depth is -1"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.detailSharpness = INFINITY; }), HasSubstr("detail_sharpness"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.startView.tanHalfFovY = 0; }), HasSubstr("start_view"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.flightPath[1].worldFromCamera[3] = NAN; }), HasSubstr("flight_path"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.axisCodebook.resize(65537); }), HasSubstr("codebook_size is 65537"));
}

TEST(HostileFile, WithParametersOutOfAllReasonIsRefusedByTheirNames) {
  const Draft draft = draftOf(richAsset());
  const auto errorWith = [&](void (*edit)(AssetContents&)) {
    Draft changed = draft;
    edit(changed.contents);
    return errorOf(changed.assemble());
  };
  EXPECT_THAT(errorWith([](AssetContents& c) { c.detailSharpness = 3e38f; }), HasSubstr("detail_sharpness is 3e+38"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.nearRatio = 3e38f; }), HasSubstr("near_ratio is 3e+38"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.nearDepth = 1e16f; }), HasSubstr("near_depth is 1e+16"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.startView.worldFromCamera[7] = 1e300; }), HasSubstr("start_view"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.flightPath[0].tanHalfFovY = 1e16; }), HasSubstr("flight_path"));
}

TEST(HostileFile, WithStringsThatAreNoUtf8IsRefused) {
  const Draft draft = draftOf(smallAsset());
  const auto errorWith = [&](auto&& edit) {
    Draft changed = draft;
    edit(changed.contents);
    return errorOf(changed.assemble());
  };
  for (const char* text : {"\x80", "a\xff", "\xc3", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                           "\xf8\x88\x80\x80\x80"}) {
    EXPECT_THAT(errorWith([&](AssetContents& c) { c.source = text; }),
                AllOf(HasSubstr("source '"), HasSubstr("no UTF-8")));
    EXPECT_THAT(errorWith([&](AssetContents& c) { c.preset = text; }), HasSubstr("preset '"));
    EXPECT_THAT(errorWith([&](AssetContents& c) { c.errors[1].unit = text; }), HasSubstr("errors '"));
  }
  EXPECT_EQ(errorWith([&](AssetContents& c) { c.source = "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x90\x8d"; }), "no error");
}

TEST(Text, ForATerminalHoldsNoControlCharacters) {
  EXPECT_EQ(printable("a\x1b[2J\r\n\a\x7f b"), "a\\x1b[2J\\x0d\\x0a\\x07\\x7f b");
  EXPECT_EQ(printable("\xc2\x9b \xff \xc3\xa9 \xe2\x82"), "\\xc2\\x9b \\xff \xc3\xa9 \\xe2\\x82");
}

TEST(HostileFile, WithALatticeThatIsNoneIsRefused) {
  const Draft draft = draftOf(smallAsset());
  const auto errorWith = [&](void (*edit)(Quantization&)) {
    Draft changed = draft;
    edit(changed.contents.quantization);
    return errorOf(changed.assemble());
  };
  EXPECT_THAT(errorWith([](Quantization& q) { q.radiusBits = 0; }), HasSubstr("radius_bits is 0, not in 1..23"));
  EXPECT_THAT(errorWith([](Quantization& q) { q.densityBits = 24; }), HasSubstr("density_bits is 24"));
  EXPECT_THAT(errorWith([](Quantization& q) { q.normalBits = 3; }), HasSubstr("normal_bits is 3, not in 4..15"));
  EXPECT_THAT(errorWith([](Quantization& q) { q.positionStep = 0.3; }), HasSubstr("position_step is 0.3"));
  EXPECT_THAT(errorWith([](Quantization& q) { q.detailSiteStep = -0.5f; }), HasSubstr("detail_site_step is -0.5"));
  EXPECT_THAT(errorWith([](Quantization& q) { q.heightStep = NAN; }), HasSubstr("height_step is nan"));
  EXPECT_THAT(errorWith([](Quantization& q) { q.colourStep = 0x1p61f; }), HasSubstr("colour_step"));
  EXPECT_THAT(errorWith([](Quantization& q) { q.lobeAxisStep = INFINITY; }), HasSubstr("lobe_axis_step is inf"));
}

// The error that an edit of the first chunk's record leads to.
std::string errorWithChunk(void (*edit)(ChunkIndex&)) {
  Draft draft = draftOf(richAsset());
  edit(draft.chunks[0]);
  return errorOf(draft.assemble());
}

TEST(HostileFile, WithAbsurdCountsIsRefusedByTheirNames) {
  constexpr uint64_t kTrillion = 1'000'000'000'000;
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.cells = kTrillion; }),
              AllOf(HasSubstr("chunk 0"), HasSubstr("cell_count is 1000000000000")));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.live = kTrillion; }),
              HasSubstr("live_count is 1000000000000"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.ghosts = kTrillion; }),
              HasSubstr("ghost_count is 1000000000000"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.pairs = kTrillion; }),
              HasSubstr("pair_count is 1000000000000"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.lobes = kTrillion; }),
              HasSubstr("lobe_count is 1000000000000"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.live = 10; }), HasSubstr("live_count is 10, not in 0..9"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.cells = 0; }), HasSubstr("cell_count"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.lobes = 25; }), HasSubstr("lobe_count is 25, not in 0..24"));
}

TEST(HostileFile, WithAnOriginOffTheGridOrNotFiniteIsRefused) {
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.origin[2] = INFINITY; }), HasSubstr("origin holds inf"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.origin[1] += 0x1p-13; }),
              HasSubstr("no multiple of the position step"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.origin[0] = 0x1p45; }),
              HasSubstr("no multiple of the position step"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.origin[0] = 1e300; }), HasSubstr("origin holds 1e+300"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.liveBounds.max[0] = 1e300; }), HasSubstr("live_bounds"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.liveBounds.min[0] = NAN; }), HasSubstr("live_bounds"));
}

TEST(HostileFile, IsRefusedIfTheCountsDoNotFitTheSections) {
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { ++c.counts.cells; }),
              AllOf(HasSubstr("section 'sites'"), HasSubstr("raw size 108, but the counts demand 120 bytes")));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { ++c.counts.ghosts; }), HasSubstr("section 'ghost_sites'"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { ++c.counts.pairs; }), HasSubstr("section 'graph_deltas'"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { ++c.counts.lobes; }), HasSubstr("section 'lobe_labels'"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { c.counts.lobes = 0; }), HasSubstr("must not be there"));
  EXPECT_THAT(errorWithChunk([](ChunkIndex& c) { --c.counts.live; }), HasSubstr("the counts demand"));
}

TEST(HostileFile, IsRefusedIfItsManifestIsNone) {
  std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  std::fill_n(bytes.begin() + sizeof(FileHeader), 64, uint8_t{0xff});
  EXPECT_THAT(errorOf(signedAgain(bytes)), HasSubstr("no FlatBuffers manifest"));
}

// ---- Sections ----

// The same record with one field changed.
struct SectionEdit {
  fb::Section& section;
  void operator()(uint64_t offset, uint64_t storedSize, uint64_t rawSize) {
    section = fb::Section(section.type(), section.chunk(), section.flags(), section.codec(), section.element_size(), 0,
                          section.base(), 0, offset, storedSize, rawSize, section.hash());
  }
};

TEST(HostileFile, IsRefusedIfASectionLiesOutsideIt) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  const auto errorAt = [&](uint64_t offset, uint64_t size) {
    return errorOf(withSection(bytes, 3, [&](fb::Section& s) { SectionEdit{s}(offset, size, s.raw_size()); }));
  };
  EXPECT_THAT(errorAt(bytes.size() - 1, 2), HasSubstr("beyond the file's"));
  EXPECT_THAT(errorAt(~uint64_t{0}, 8), HasSubstr("beyond the file's"));
  EXPECT_THAT(errorAt(8, ~uint64_t{0}), HasSubstr("beyond the file's"));
}

TEST(HostileFile, IsRefusedIfSectionsOverlap) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  for (const uint64_t shift : {uint64_t{1}, bytes.size() / 2}) {
    const std::vector<uint8_t> moved = withSection(
        bytes, 20, [&](fb::Section& s) { SectionEdit{s}(s.offset() - shift, s.stored_size(), s.raw_size()); });
    EXPECT_THAT(errorOf(moved), HasSubstr("overlaps"));
  }
}

TEST(HostileFile, IsRefusedIfASectionsRawSizeLies) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  for (const uint64_t rawSize : {uint64_t{0}, uint64_t{35}, uint64_t{40}, uint64_t{1} << 50, ~uint64_t{0}}) {
    EXPECT_THAT(
        errorOf(withSection(bytes, 0, [&](fb::Section& s) { SectionEdit{s}(s.offset(), s.stored_size(), rawSize); })),
        HasSubstr("the counts demand 36 bytes"));
  }
}

TEST(HostileFile, IsRefusedIfASectionExistsTwice) {
  Draft draft = draftOf(smallAsset());
  draft.add(draft.records[2], draft.stored[2]);
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("exists twice"));
}

TEST(HostileFile, IsRefusedIfASectionIsMissing) {
  const Draft draft = draftOf(smallAsset());
  for (size_t i = 0; i < draft.records.size(); ++i) {
    Draft changed = draft;
    changed.records.erase(changed.records.begin() + static_cast<ptrdiff_t>(i));
    changed.stored.erase(changed.stored.begin() + static_cast<ptrdiff_t>(i));
    const uint32_t type = draft.records[i].type;
    const bool isOptional = type == static_cast<uint32_t>(SectionType::kDetailHeights) ||
                            type == static_cast<uint32_t>(SectionType::kDetailSites);
    EXPECT_THAT(errorOf(changed.assemble()), HasSubstr(isOptional ? "no error" : "is missing"));
  }
}

TEST(HostileFile, WithAnUnknownSectionIsReadUnlessItIsCritical) {
  const AssetContents contents = smallAsset();
  Draft draft = draftOf(contents);
  SectionRecord unknown;
  unknown.type = 4711;
  unknown.codec = 99;
  draft.add(unknown, {1, 2, 3});
  Result<AssetContents> found = decodeAsset(draft.assemble());
  ASSERT_TRUE(found) << found.error().message;
  expectSameAsset(*found, contents);

  draft.records.back().flags = kSectionCritical;
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("section of type 4711: unknown and critical"));
}

TEST(HostileFile, IsRefusedWithReservedFlagsAndReadWithUnusedOnes) {
  Draft draft = draftOf(smallAsset());
  draft.records[0].flags = kSectionCritical | 0x0002;
  EXPECT_EQ(errorOf(draft.assemble()), "no error");
  draft.records[0].flags = kSectionCritical | 0x0100;
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("reserved bits"));
}

TEST(HostileFile, IsRefusedWithReservedBytesOfASection) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  const auto errorWith = [&](uint16_t reserved0, uint32_t reserved1) {
    return errorOf(withSection(bytes, 2, [&](fb::Section& s) {
      s = fb::Section(s.type(), s.chunk(), s.flags(), s.codec(), s.element_size(), reserved0, s.base(), reserved1,
                      s.offset(), s.stored_size(), s.raw_size(), s.hash());
    }));
  };
  EXPECT_EQ(errorWith(0, 0), "no error");
  EXPECT_THAT(errorWith(1, 0), HasSubstr("reserved bits"));
  EXPECT_THAT(errorWith(0, 1u << 31), HasSubstr("reserved bits"));
}

TEST(HostileFile, IsRefusedWithAnUnknownCodecOrChunk) {
  Draft draft = draftOf(smallAsset());
  draft.records[0].codec = 6;
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("unknown codec 6"));
  draft = draftOf(smallAsset());
  draft.records[0].chunk = 17;
  EXPECT_THAT(errorOf(draft.assemble()), AllOf(HasSubstr("chunk 17, section 'sites'"), HasSubstr("there are 2")));
}

TEST(HostileFile, IsRefusedWithElementsOfAnotherSizeOrABase) {
  const Draft draft = draftOf(richAsset());
  const auto errorWith = [&](SectionType type, uint32_t elementSize, uint32_t base) {
    Draft changed = draft;
    SectionRecord& record = changed.records[changed.find(type)];
    record.rawSize = record.rawSize / record.elementSize * elementSize;
    record.elementSize = elementSize;
    record.base = base;
    return errorOf(changed.assemble());
  };
  for (const uint32_t size : {0u, 3u, 8u, 65535u}) {
    EXPECT_THAT(errorWith(SectionType::kRadii, size, 0), HasSubstr("section 'radii': elements of"));
  }
  EXPECT_THAT(errorWith(SectionType::kSites, 2, 0), HasSubstr("section 'sites': elements of 2 bytes"));
  EXPECT_THAT(errorWith(SectionType::kGraphDeltas, 4, 0), HasSubstr("'graph_deltas': elements of 4 bytes"));
  EXPECT_THAT(errorWith(SectionType::kBaseColours, 1, 7), HasSubstr("base is 7, these elements have none"));
}

TEST(HostileFile, IsRefusedWithASectionThatItsLatticesOrCountsRuleOut) {
  Draft draft = draftOf(makeSampleAsset({.hasWalkGraph = false}));
  SectionRecord bits;
  bits.type = static_cast<uint32_t>(SectionType::kGraphAlphaBits);
  bits.elementSize = 1;
  bits.rawSize = 2;
  draft.add(bits, {0, 0});
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("section 'graph_alpha_bits': must not be there"));
}

TEST(HostileFile, IsRefusedIfACodebookBelongsToAChunkOrAnArrayToNone) {
  const Draft draft = draftOf(richAsset());
  Draft changed = draft;
  changed.records[changed.find(SectionType::kAxisCodebook, kSharedChunk)].chunk = 0;
  EXPECT_THAT(errorOf(changed.assemble()), HasSubstr("section 'axis_codebook': belongs to no such chunk"));
  changed = draft;
  changed.records[changed.find(SectionType::kSites)].chunk = kSharedChunk;
  EXPECT_THAT(errorOf(changed.assemble()), HasSubstr("shared, section 'sites': belongs to no such chunk"));
}

}  // namespace
}  // namespace froth
