// Any bytes give contents or a named error.
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "asset_equality.h"
#include "file_surgery.h"
#include "format/asset_reader.h"
#include "sample_asset.h"

namespace froth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

AssetContents smallAsset() {
  return makeSampleAsset(
      {.chunkCount = 2, .cellsPerChunk = 3, .localBits = 2, .detailCount = 1, .lobeCount = 1});
}

std::string errorOf(std::span<const uint8_t> bytes) {
  Result<AssetContents> contents = decodeAsset(bytes);
  return contents ? "no error" : contents.error().message;
}

TEST(HostileFile, IsRefusedWhenTruncatedAtAnyLength) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  for (size_t length = 0; length < bytes.size(); ++length) {
    // An allocation of this very length, so that a sanitizer sees a read past its end.
    const std::vector<uint8_t> part(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(length));
    ASSERT_FALSE(decodeAsset(part)) << "cut to " << length << " of " << bytes.size() << " bytes";
  }
}

TEST(HostileFile, IsRefusedWithAnAppendedByte) {
  std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  bytes.push_back(0);
  EXPECT_THAT(errorOf(bytes), AllOf(HasSubstr("scene.froth"), HasSubstr("its header says")));
}

TEST(HostileFile, GivesAnErrorOrTheSameContentsForEveryFlippedBit) {
  const AssetContents contents = smallAsset();
  std::vector<uint8_t> bytes = encodeOrFail(contents);
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

// An attacker's hashes fit, so every later check must hold alone. The sanitizers show a wrong read.
TEST(HostileFile, SurvivesEveryFlippedBitThatIsSignedAgain) {
  std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  size_t refused = 0;
  for (size_t bit = sizeof(FileHeader) * 8; bit < bytes.size() * 8; ++bit) {
    const uint8_t mask = static_cast<uint8_t>(1u << (bit % 8));
    bytes[bit / 8] ^= mask;
    if (!decodeAsset(signedAgain(bytes))) ++refused;
    bytes[bit / 8] ^= mask;
  }
  EXPECT_GT(refused, 0u);
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

TEST(HostileFile, OfANewerMajorVersionIsRefusedByItsVersion) {
  const std::vector<uint8_t> bytes =
      withHeader(encodeOrFail(smallAsset()), [](FileHeader& header) { header.versionMajor = 2; });
  EXPECT_THAT(errorOf(bytes), HasSubstr("format version 2.0, this program reads 1"));
}

TEST(HostileFile, OfANewerMinorVersionIsRead) {
  const std::vector<uint8_t> bytes =
      withHeader(encodeOrFail(smallAsset()), [](FileHeader& header) { header.versionMinor = 9; });
  EXPECT_EQ(errorOf(bytes), "no error");
}

TEST(HostileFile, IsRefusedWithReservedHeaderBytes) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  EXPECT_THAT(errorOf(withHeader(bytes, [](FileHeader& header) { header.reserved0 = 1; })),
              HasSubstr("reserved"));
  EXPECT_THAT(errorOf(withHeader(bytes, [](FileHeader& header) { header.reserved1 = 1; })),
              HasSubstr("reserved"));
}

TEST(HostileFile, IsRefusedWithAManifestOutsideTheFile) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  for (const uint64_t size :
       {uint64_t{bytes.size()}, uint64_t{1} << 40, std::numeric_limits<uint64_t>::max()})
    EXPECT_FALSE(decodeAsset(withHeader(bytes, [&](FileHeader& header) { header.manifestSize = size; })));
  EXPECT_FALSE(
      decodeAsset(withHeader(bytes, [](FileHeader& header) { header.manifestOffset = ~uint64_t{0}; })));
}

// ---- Manifest ----

TEST(HostileFile, WithParametersOutOfRangeIsRefusedByTheirNames) {
  const Draft draft = draftOf(smallAsset());
  const auto errorWith = [&](void (*edit)(AssetContents&)) {
    Draft changed = draft;
    edit(changed.contents);
    return errorOf(changed.assemble());
  };
  EXPECT_THAT(errorWith([](AssetContents& c) { c.detailCount = 33; }),
              HasSubstr("detail_count is 33, not in 1..32"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.lobeCount = 0; }), HasSubstr("lobe_count is 0"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.localBits = 33; }), HasSubstr("local_bits is 33"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.localBits = 1; }), HasSubstr("cell_count is 3"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.localBits = 32; }), HasSubstr("number of chunks is 2"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.nearRatio = NAN; }), HasSubstr("near_ratio"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.nearDepth = -1; }), HasSubstr("near_depth is -1"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.detailSharpness = INFINITY; }),
              HasSubstr("detail_sharpness"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.startView.tanHalfFovY = 0; }), HasSubstr("start_view"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.flightPath[1].worldFromCamera[3] = NAN; }),
              HasSubstr("flight_path"));
  EXPECT_THAT(errorWith([](AssetContents& c) { c.chunks[0].origin[2] = INFINITY; }), HasSubstr("origin"));
}

fb::Chunk withCounts(const fb::Chunk& chunk, uint64_t cells, uint64_t live, uint64_t neighbours) {
  return fb::Chunk(chunk.origin(), cells, live, neighbours, chunk.live_bounds());
}

TEST(HostileFile, WithAbsurdCountsIsRefusedByTheirNames) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  constexpr uint64_t kTrillion = 1'000'000'000'000;
  EXPECT_THAT(errorOf(withChunk(bytes, [](fb::Chunk& c) { c = withCounts(c, kTrillion, 2, 15); })),
              AllOf(HasSubstr("chunk 0"), HasSubstr("cell_count is 1000000000000")));
  EXPECT_THAT(errorOf(withChunk(bytes, [](fb::Chunk& c) { c = withCounts(c, 3, kTrillion, 15); })),
              HasSubstr("live_count is 1000000000000"));
  EXPECT_THAT(errorOf(withChunk(bytes, [](fb::Chunk& c) { c = withCounts(c, 3, 2, kTrillion); })),
              HasSubstr("neighbour_count is 1000000000000"));
  EXPECT_THAT(errorOf(withChunk(bytes, [](fb::Chunk& c) { c = withCounts(c, 3, 4, 15); })),
              HasSubstr("live_count is 4, not in 0..3"));
  EXPECT_THAT(errorOf(withChunk(bytes, [](fb::Chunk& c) { c = withCounts(c, 0, 0, 15); })),
              HasSubstr("cell_count"));
}

TEST(HostileFile, IsRefusedIfTheCountsDoNotFitTheSections) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  EXPECT_THAT(errorOf(withChunk(bytes, [](fb::Chunk& c) { c = withCounts(c, 4, 2, 15); })),
              AllOf(HasSubstr("section 'sites'"), HasSubstr("raw size 36, but the counts demand 48 bytes")));
  EXPECT_THAT(errorOf(withChunk(bytes, [](fb::Chunk& c) { c = withCounts(c, 3, 2, 16); })),
              HasSubstr("section 'neighbours'"));
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
    section = fb::Section(section.type(), section.chunk(), section.flags(), section.codec(), 0, offset,
                          storedSize, rawSize, section.hash());
  }
};

TEST(HostileFile, IsRefusedIfASectionLiesOutsideIt) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  const auto errorAt = [&](uint64_t offset, uint64_t size) {
    return errorOf(
        withSection(bytes, 3, [&](fb::Section& s) { SectionEdit{s}(offset, size, s.raw_size()); }));
  };
  EXPECT_THAT(errorAt(bytes.size() - 1, 2), HasSubstr("beyond the file's"));
  EXPECT_THAT(errorAt(~uint64_t{0}, 8), HasSubstr("beyond the file's"));
  EXPECT_THAT(errorAt(8, ~uint64_t{0}), HasSubstr("beyond the file's"));
}

TEST(HostileFile, IsRefusedIfSectionsOverlap) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  for (const uint64_t shift : {uint64_t{1}, bytes.size() / 2}) {
    const std::vector<uint8_t> moved = withSection(bytes, 21, [&](fb::Section& s) {
      SectionEdit{s}(s.offset() - shift, s.stored_size(), s.raw_size());
    });
    EXPECT_THAT(errorOf(moved), HasSubstr("overlaps"));
  }
}

TEST(HostileFile, IsRefusedIfASectionsRawSizeLies) {
  const std::vector<uint8_t> bytes = encodeOrFail(smallAsset());
  for (const uint64_t rawSize : {uint64_t{0}, uint64_t{35}, uint64_t{40}, uint64_t{1} << 50, ~uint64_t{0}})
    EXPECT_THAT(errorOf(withSection(
                    bytes, 0, [&](fb::Section& s) { SectionEdit{s}(s.offset(), s.stored_size(), rawSize); })),
                HasSubstr("the counts demand 36 bytes"));
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
    const bool isOptional = draft.records[i].type == static_cast<uint32_t>(SectionType::kDetailHeights);
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

TEST(HostileFile, IsRefusedWithAnUnknownCodecOrChunk) {
  Draft draft = draftOf(smallAsset());
  draft.records[0].codec = 3;
  EXPECT_THAT(errorOf(draft.assemble()), HasSubstr("unknown codec 3"));
  draft = draftOf(smallAsset());
  draft.records[0].chunk = 17;
  EXPECT_THAT(errorOf(draft.assemble()),
              AllOf(HasSubstr("chunk 17, section 'sites'"), HasSubstr("only 2 chunks")));
}

}  // namespace
}  // namespace froth
