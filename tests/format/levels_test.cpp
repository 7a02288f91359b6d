// Levels of detail in the file: they come back as written, a chunk is one range, and what breaks their rules is refused
// by name.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "asset_equality.h"
#include "base/atomic_file.h"
#include "file_surgery.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "level_sample.h"

namespace froth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const AssetContents& sample() {
  static const AssetContents contents = makeLevelSample({.cellCount = 400});
  return contents;
}

// Chunks of the sample: 0 and 1 the floor, 2..9 level 1, then level 0; groups 0..3 of level 0, 4 and 5 of level 1.
constexpr uint32_t kFloorChunks = 2;

TEST(Levels, ComeBackAsWritten) {
  const Result<AssetContents> found = decodeAsset(encodeOrFail(sample()));
  ASSERT_TRUE(found) << found.error().message;
  expectSameAsset(*found, sample());
}

TEST(Levels, AChunkIsOneRangeAndTheFloorIsOneRangeBeforeAllOthers) {
  const std::vector<uint8_t> bytes = encodeOrFail(sample());
  const Result<AssetReader> reader = AssetReader::openBytes(bytes, "scene.froth");
  ASSERT_TRUE(reader);
  std::vector<ByteRange> floor;
  for (uint32_t chunk = 0; chunk < kFloorChunks; ++chunk) {
    for (const ByteRange& range : reader->rangesOf(chunk)) floor.push_back(range);
  }
  std::ranges::sort(floor, {}, &ByteRange::offset);
  for (size_t i = 1; i < floor.size(); ++i) EXPECT_EQ(floor[i].offset, floor[i - 1].offset + floor[i - 1].size);
  uint64_t end = floor.back().offset + floor.back().size;
  for (uint32_t chunk = kFloorChunks; chunk < sample().chunks.size(); ++chunk) {
    const std::vector<ByteRange> ranges = reader->rangesOf(chunk);
    ASSERT_EQ(ranges.size(), 1u) << "chunk " << chunk;
    EXPECT_EQ(ranges[0].offset, end) << "chunk " << chunk;
    end += ranges[0].size;
  }
  EXPECT_EQ(end, bytes.size());
}

// ---- Writing in the order of a bake

std::filesystem::path scenePath() {
  return std::filesystem::path(testing::TempDir()) /
         (std::string("levels_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".froth");
}

Result<uint64_t> writeInOrder(const std::vector<uint32_t>& bakeOrder, const std::vector<uint32_t>& order) {
  AssetContents header = sample();
  header.levels.clear();  // what a bake knows at the start
  header.groups.clear();
  header.borderCount = 0;
  Result<AssetStreamWriter> writer = AssetStreamWriter::create(scenePath(), header);
  if (!writer) return writer.error();
  for (const uint32_t chunk : bakeOrder) {
    Result<EncodedChunk> encoded = writer->encodeChunk(sample().chunks[chunk]);
    if (!encoded) return encoded.error();
    if (Status status = writer->append(std::move(*encoded)); !status) return status.error();
  }
  return writer->finish(sample(), order);
}

TEST(Levels, ChunksComeInAnyOrderAndGiveTheSameFile) {
  std::vector<uint32_t> bakeOrder(sample().chunks.size());
  std::iota(bakeOrder.rbegin(), bakeOrder.rend(), 0u);
  std::shuffle(bakeOrder.begin(), bakeOrder.end(), std::mt19937(3));
  std::vector<uint32_t> order(bakeOrder.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[bakeOrder[i]] = i;
  const Result<uint64_t> size = writeInOrder(bakeOrder, order);
  ASSERT_TRUE(size) << size.error().message;
  EXPECT_EQ(*readFile(scenePath()), encodeOrFail(sample()));
  std::filesystem::remove(scenePath());
}

TEST(Levels, AnOrderThatDoesNotNameEachChunkOnceIsRefused) {
  std::vector<uint32_t> all(sample().chunks.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<uint32_t> twice = all, fewer = all;
  twice[3] = 4;
  fewer.pop_back();
  for (const std::vector<uint32_t>& order : {twice, fewer}) {
    const Result<uint64_t> size = writeInOrder(all, order);
    ASSERT_FALSE(size);
    EXPECT_THAT(size.error().message, HasSubstr("does not name each of the 18 once"));
  }
}

// ---- Files that break a rule

std::string messageOf(const Result<AssetContents>& found) { return found ? "no error" : found.error().message; }

// The error of a reader when the manifest is edited, and that of the writer.
std::string errorAfter(const std::function<void(AssetContents&)>& edit) {
  Draft draft = draftOf(sample());
  edit(draft.contents);
  const std::string read = messageOf(decodeAsset(draft.assemble()));
  AssetContents contents = sample();
  edit(contents);
  EXPECT_FALSE(encodeAsset(contents)) << read;
  return read;
}

TEST(Levels, AreRefusedWithoutGroupsAndTheOtherWayRound) {
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups.clear(); }), HasSubstr("18 levels of chunks and 0 groups"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels.clear(); }), HasSubstr("0 levels of chunks and 6 groups"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels.pop_back(); }),
              HasSubstr("levels of 17 chunks, there are 18"));
}

TEST(Levels, AreRefusedWithAChunkOutOfPlace) {
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[2].in = 6; }),
              HasSubstr("chunk 2: in is group 6, there are 6"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[2].madeBy = 7; }), HasSubstr("made_by is group 7"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[12].madeBy = 0; }), HasSubstr("level 0, made by group 0"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[2].madeBy = kNoGroup; }),
              HasSubstr("level 1, made by no group"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[2].madeBy = 4; }), HasSubstr("made by group 4 of level 1"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[2].in = 0; }), HasSubstr("level 1, in group 0 of level 0"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[17].in = kNoGroup; }),
              HasSubstr("chunk 17: belongs to the floor, but stands behind"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { std::swap(a.levels[9], a.levels[10]); }),
              HasSubstr("chunk 10: level 1 behind level 0"));
}

TEST(Levels, AreRefusedWithAGroupThatLacksAForm) {
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups.push_back({.level = 1}); }),
              HasSubstr("group 6: 0 fine and 0 coarse chunks"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.levels[1].madeBy = 4; }), HasSubstr("group 5: 4 fine and 0 coarse"));
}

TEST(Levels, AreRefusedWithNumbersOfAGroupThatCannotBe) {
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups[1].error = NAN; }), HasSubstr("group 1: error is nan"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups[1].error = -1; }), HasSubstr("group 1: error is -1"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups[2].radius = INFINITY; }), HasSubstr("group 2: radius is inf"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups[2].centre[1] = 0x1p60; }), HasSubstr("group 2: centre holds"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups[0].error = a.groups[4].error; }),
              HasSubstr("group 0: error 0.02 is not less than the 0.02 of group 4"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.groups[4].radius *= 0.5; }),
              HasSubstr("sticks out of that of group 4"));
}

TEST(Levels, AreRefusedWithBordersThatNobodyHolds) {
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.borderCount = 1u << 31; }), HasSubstr("border_count is 2147483648"));
  EXPECT_THAT(errorAfter([](AssetContents& a) { a.borderCount = 3; }),
              AllOf(HasSubstr("section 'ghost_refs': border"), HasSubstr("there are 3")));
}

// The error after an edit of the borders of chunk 12; the writer refuses it too.
std::string errorOfBorders(const std::function<void(ChunkContents&)>& edit) {
  AssetContents contents = sample();
  edit(contents.chunks[12]);
  const Result<std::vector<uint8_t>> bytes = encodeAsset(contents);
  return bytes ? messageOf(decodeAsset(*bytes)) : bytes.error().message;
}

TEST(Levels, AreRefusedWithBordersThatAreNoneOfTheirChunk) {
  EXPECT_THAT(errorOfBorders([](ChunkContents& c) { c.borderCells[1] = c.borderCells[0]; }),
              HasSubstr("'border_cells': "));
  EXPECT_THAT(errorOfBorders([](ChunkContents& c) { c.borderCells.back() = c.cellCount; }),
              HasSubstr("'border_cells': cell"));
  EXPECT_THAT(errorOfBorders([](ChunkContents& c) { c.borderNumbers[1] = c.borderNumbers[0]; }),
              HasSubstr("stands there twice"));
  EXPECT_THAT(errorOfBorders([](ChunkContents& c) { c.borderNumbers[0] = c.ghostRefs[0]; }),
              HasSubstr("which is a cell of the chunk"));
  EXPECT_THAT(errorOfBorders([](ChunkContents& c) { c.borderNumbers[0] = 1u << 30; }),
              HasSubstr("'border_numbers': border 1073741824"));
  EXPECT_THAT(errorOfBorders([](ChunkContents& c) { c.borderNumbers.pop_back(); }), HasSubstr("border_numbers; bake"));
}

TEST(Levels, ASectionOfBordersIsCheckedWhenItIsRead) {
  for (const SectionType type : {SectionType::kBorderCells, SectionType::kBorderNumbers}) {
    Draft draft = draftOf(sample());
    std::vector<uint32_t> numbers =
        type == SectionType::kBorderCells ? sample().chunks[0].borderCells : sample().chunks[0].borderNumbers;
    numbers[0] = 0xfffffff0;
    draft.replace(type, rawBytes(numbers));
    EXPECT_THAT(messageOf(decodeAsset(draft.assemble())), HasSubstr(sectionName(static_cast<uint32_t>(type))));
    const ptrdiff_t at = static_cast<ptrdiff_t>(draft.find(type));
    draft.records.erase(draft.records.begin() + at);
    draft.stored.erase(draft.stored.begin() + at);
    EXPECT_THAT(messageOf(decodeAsset(draft.assemble())), HasSubstr("is missing"));
  }
}

// ---- What verifyAsset finds

std::string verifyAfter(const std::function<void(AssetContents&)>& edit) {
  AssetContents contents = sample();
  edit(contents);
  EXPECT_TRUE(writeFileAtomically(scenePath(), encodeOrFail(contents)));
  const Status status = verifyAsset(scenePath());
  std::filesystem::remove(scenePath());
  return status ? "no error" : status.error().message;
}

TEST(VerifyLevels, FindsNothingWrongWithTheSample) {
  EXPECT_EQ(verifyAfter([](AssetContents&) {}), "no error");
}

TEST(VerifyLevels, FindsABorderThatIsNotTheSameBallEverywhere) {
  EXPECT_THAT(verifyAfter([](AssetContents& a) { a.chunks[12].radii[a.chunks[12].borderCells[0]] += 0.5f; }),
              AllOf(HasSubstr(": border "), HasSubstr(", is not where cell")));
  EXPECT_THAT(verifyAfter([](AssetContents& a) {
                ChunkContents& chunk = a.chunks[12];
                chunk.radii[chunk.cellCount] += 0.5f;
              }),
              HasSubstr("chunk 12: ghost 0 is not where"));
}

TEST(VerifyLevels, FindsABorderThatNoChunkHolds) {
  EXPECT_THAT(verifyAfter([](AssetContents& a) { ++a.borderCount; }), HasSubstr("is in no chunk"));
}

TEST(VerifyLevels, FindsAGhostThatItsLevelDoesNotHold) {
  EXPECT_THAT(verifyAfter([](AssetContents& a) {
                ChunkContents& chunk = a.chunks[12];
                chunk.borderCells.erase(chunk.borderCells.begin());
                chunk.borderNumbers.erase(chunk.borderNumbers.begin());
              }),
              HasSubstr("which no chunk of its level holds"));
}

TEST(VerifyLevels, FindsABallThatDoesNotHoldTheCells) {
  EXPECT_THAT(verifyAfter([](AssetContents& a) { a.groups[0].radius *= 0.5; }),
              AllOf(HasSubstr("the ball of live cell"), HasSubstr("sticks out of that of group 0")));
}

// Takes one pair across groups out of level 1, in both of its chunks, as a merge would that has changed a border.
TEST(VerifyLevels, FindsAPairAcrossGroupsThatOneFormAloneHas) {
  EXPECT_THAT(verifyAfter([](AssetContents& a) {
                // Chunks of level 1, made by other groups and in one group: cell and ghost of a pair between them.
                const auto removePair = [&](ChunkContents& chunk, uint32_t own, uint32_t other) {
                  const auto number = std::find(chunk.borderNumbers.begin(), chunk.borderNumbers.end(), own);
                  const uint32_t cell = chunk.borderCells[static_cast<size_t>(number - chunk.borderNumbers.begin())];
                  const auto ref = std::find(chunk.ghostRefs.begin(), chunk.ghostRefs.end(), other);
                  const uint32_t ghost = chunk.cellCount + static_cast<uint32_t>(ref - chunk.ghostRefs.begin());
                  const auto first = chunk.neighbours.begin() + chunk.neighbourOffsets[cell];
                  const auto last = chunk.neighbours.begin() + chunk.neighbourOffsets[cell + 1];
                  const auto at = std::find(first, last, ghost);
                  if (at == last) return false;
                  if (cell < chunk.liveCount && at - first < chunk.alphaCounts[cell]) --chunk.alphaCounts[cell];
                  chunk.neighbours.erase(at);
                  for (uint32_t c = cell + 1; c <= chunk.cellCount; ++c) --chunk.neighbourOffsets[c];
                  return true;
                };
                ChunkContents &one = a.chunks[2], &two = a.chunks[3];
                for (const uint32_t own : one.borderNumbers) {
                  for (const uint32_t other : two.borderNumbers) {
                    if (!std::binary_search(one.ghostRefs.begin(), one.ghostRefs.end(), other) ||
                        !std::binary_search(two.ghostRefs.begin(), two.ghostRefs.end(), own)) {
                      continue;
                    }
                    if (removePair(one, own, other) && removePair(two, other, own)) return;
                  }
                }
              }),
              HasSubstr("are neighbours in one of its forms only"));
}

}  // namespace
}  // namespace froth
