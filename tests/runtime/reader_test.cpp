// Assets whose bytes come from the caller's reader: froth_reader.h.
#include "reader_fixture.h"

#include "format/container.h"
#include "format/read/asset_reader.h"
#include "froth/froth_precompile.h"
#include "one_cell_chunks.h"

namespace froth {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr uint64_t kFirstRead = 64u << 10;

TEST_F(Reader, ThatAnswersAtOnceLoadsInAFrameWhatThePathLoads) {
  archive_.answersWithinRead = true;
  const FrothAsset asset = open(small_);
  EXPECT_THAT(archive_.asked, IsEmpty()) << "nothing is read before frothUpdate";
  const FrothAsset file = openPath(writeFile("scene.froth", small_));
  runFrame();
  const FrothAssetStatus status = statusOf(asset), expected = statusOf(file);
  EXPECT_EQ(status.state, FROTH_ASSET_READY) << lastText();
  EXPECT_EQ(expected.state, FROTH_ASSET_READY);
  EXPECT_EQ(status.cellCount, expected.cellCount);
  EXPECT_EQ(status.liveCount, expected.liveCount);
  EXPECT_EQ(status.lobeCount, expected.lobeCount);
  EXPECT_EQ(status.chunkCount, 3u);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(status.boundsMin[axis], expected.boundsMin[axis]);
    EXPECT_EQ(status.boundsMax[axis], expected.boundsMax[axis]);
  }
  EXPECT_THAT(messages_, IsEmpty());
}

TEST_F(Reader, ThatAnswersNothingHoldsUpNoFrame) {
  const FrothAsset asset = open(large_), other = openPath(writeFile("scene.froth", small_));
  for (int frame = 0; frame < 10; ++frame) runFrame();
  EXPECT_EQ(archive_.asked.size(), 1u) << "the head, once";
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_OPENING);
  EXPECT_EQ(stateOf(other), FROTH_ASSET_READY);
  load(asset);
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
}

TEST_F(Reader, MayAnswerChunksInAnyOrder) {
  const FrothAsset asset = open(large_);
  runFrame();
  archive_.answerAll();
  runFrame();
  ASSERT_GT(archive_.pending.size(), 4u) << "chunks are read ahead";
  while (archive_.pending.size() > 1) {
    EXPECT_EQ(archive_.answer(archive_.pending.size() - 1), FROTH_OK);
    runFrame();
    EXPECT_EQ(stateOf(asset), FROTH_ASSET_OPENING);
  }
  archive_.answerAll();
  runFrame();
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
}

TEST_F(Reader, IsAskedOnceForChunksAndForTheWantedLayersAlone) {
  Result<AssetReader> file = AssetReader::openBytes(large_, "large");
  ASSERT_TRUE(file);
  for (const uint32_t layers : {1u, 2u, 3u}) {
    archive_.asked.clear();
    const FrothAsset asset = open(large_, layers);
    load(asset);
    EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
    std::vector<int> reads(large_.size());
    for (const Archive::Request& request : archive_.asked) {
      for (uint64_t i = request.offset; i < request.offset + request.size; ++i) {
        if (i >= kFirstRead) ++reads[i];
      }
    }
    EXPECT_LE(*std::ranges::max_element(reads), 1);
    for (const SectionRecord& section : file->sections()) {
      const bool isWanted = static_cast<uint32_t>(sectionLayer(static_cast<SectionType>(section.type))) < layers;
      for (uint64_t i = section.offset; i < section.offset + section.storedSize; ++i) {
        ASSERT_TRUE(i < kFirstRead || reads[i] == isWanted) << sectionName(section.type);
      }
    }
    EXPECT_EQ(archive_.asked.size(), 1 + 4 * layers) << "a range for each layer of a chunk";
    EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  }
}

TEST_F(Reader, IsAskedAgainForALongManifestAndTheCodebookBehindIt) {
  const std::vector<uint8_t> bytes =
      encodeSample({.chunkCount = 90, .cellsPerChunk = 1, .localBits = 8, .isQuantized = true, .codebookSize = 3});
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  const uint64_t manifestEnd = header.manifestOffset + header.manifestSize;
  ASSERT_GT(manifestEnd, kFirstRead);
  const FrothAsset asset = open(bytes);
  load(asset);
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
  ASSERT_GT(archive_.asked.size(), 3u);
  EXPECT_EQ(archive_.asked[0].offset, 0u);
  EXPECT_EQ(archive_.asked[0].size, kFirstRead);
  EXPECT_EQ(archive_.asked[1].offset, kFirstRead);
  EXPECT_EQ(archive_.asked[1].size, manifestEnd - kFirstRead);
  EXPECT_EQ(archive_.asked[2].offset, manifestEnd) << "the codebook";
}

TEST_F(Reader, IsAskedForAFewRangesAtATime) {
  const FrothAsset asset = open(*encodeAsset(makeOneCellChunks(300)));
  load(asset);
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
  EXPECT_GT(archive_.mostPending, 16u);
  EXPECT_LE(archive_.mostPending, 32u);
  EXPECT_LE(archive_.mostPendingBytes, 16u << 20);
}

TEST_F(Reader, ThatFailsAtTheHeadFailsTheAsset) {
  const FrothAsset asset = open(small_);
  runFrame();
  archive_.answerAll(FROTH_ERROR_FILE);
  expectFailure(asset, FROTH_ERROR_FILE);
  EXPECT_THAT(messages_[0].text,
              AllOf(HasSubstr(std::to_string(small_.size()) + " bytes at byte 0"), HasSubstr("FROTH_ERROR_FILE")));
}

TEST_F(Reader, ThatFailsAtAChunkFailsTheAssetAndTheOtherReadsAreCancelled) {
  const FrothAsset asset = open(large_);
  runFrame();
  archive_.answerAll();
  runFrame();
  const Archive::Request first = archive_.pending[0];
  const size_t others = archive_.pending.size() - 3;
  for (int range = 0; range < 3; ++range) archive_.answer(0, range == 0 ? FROTH_ERROR_MEMORY : FROTH_OK);
  expectFailure(asset, FROTH_ERROR_MEMORY);
  EXPECT_THAT(messages_[0].text, HasSubstr(std::to_string(first.size) + " bytes at byte " +
                                           std::to_string(first.offset) + ": the reader answered FROTH_ERROR_MEMORY"));
  EXPECT_EQ(archive_.cancelled.size(), others);
}

TEST_F(Reader, OfAnotherSizeFailsTheAssetWithBothSizes) {
  for (const int more : {-1, 1, -static_cast<int>(small_.size()) + 10}) {
    archive_.bytes = small_;
    FrothReader reader = archive_.reader();
    reader.size = static_cast<uint64_t>(static_cast<int64_t>(reader.size) + more);
    const FrothAsset asset = openReader(reader);
    runFrame();
    archive_.answerAll();
    expectFailure(asset, FROTH_ERROR_FILE);
    EXPECT_THAT(messages_[0].text, HasSubstr(reader.size < sizeof(FileHeader) ? "do not lie within the file's 10"
                                                                              : "bytes long, its header says"));
    messages_.clear();
  }
}

TEST_F(Reader, ThatDeliversOtherBytesFailsTheAssetAtTheSection) {
  std::vector<uint8_t> bytes = large_;
  bytes[bytes.size() - 1] ^= 1;
  const FrothAsset asset = open(bytes);
  load(asset);
  expectFailure(asset, FROTH_ERROR_FILE);
  EXPECT_THAT(messages_[0].text, HasSubstr("chunk 3, section 'lobe_colours'"));
}

TEST_F(Reader, UnderATimeLimitIsAskedInEachFrame) {
  archive_.answersWithinRead = true;
  const FrothAsset asset = open(large_);
  int frames = 0;
  for (; frames < 100 && stateOf(asset) == FROTH_ASSET_OPENING; ++frames) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = ++serial_;
    frame.completedSerial = serial_ - 1;
    frame.loadMicroseconds = 1;
    const size_t asked = archive_.asked.size();
    ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK);
    EXPECT_LE(archive_.asked.size(), asked + 6);  // a chunk for decoding, one after it
  }
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY);
  EXPECT_GT(frames, 3);
}

TEST_F(Reader, IsCheckedWhenTheAssetIsOpened) {
  archive_.bytes = small_;
  FrothReader reader = archive_.reader();
  FrothAssetInfo info = infoOf(reader);
  FrothAsset asset{};
  info.path = "x";
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("more than one is set"));
  info.structSize = offsetof(FrothAssetInfo, reader);  // an older header
  info.path = nullptr;
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("none is set"));
  info = infoOf(reader);
  reader.size = 0;
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("reader.size: 0"));
  reader = archive_.reader();
  reader.read = nullptr;
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("reader.read: null"));
  reader = archive_.reader();
  reader.structSize = 0;
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("reader.structSize: 0"));
  FrothVariant variant{};
  EXPECT_EQ(frothReadVariant(context_, &info, &variant), FROTH_ERROR_UNSUPPORTED);
  EXPECT_THAT(lastText(), HasSubstr("give path or data"));
}

}  // namespace
}  // namespace froth
