#include "format/container.h"
#include "froth/froth_stream.h"
#include "one_cell_chunks.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Without a device: the same states, no GPU memory.
class AssetOfNullContext : public RuntimeTest {
 protected:
  void SetUp() override { createContext(); }

  // The asset after some frames; it must have failed, with one message, while frames go on.
  FrothAssetStatus failedStatus(FrothAsset asset, FrothResult error) {
    for (uint64_t serial = 1; serial <= 3; ++serial) {
      EXPECT_EQ(update(serial), FROTH_OK);
      EXPECT_EQ(frothRecordUpload(context_, nullptr), FROTH_OK);
    }
    const FrothAssetStatus status = statusOf(asset);
    EXPECT_EQ(status.state, FROTH_ASSET_FAILED);
    EXPECT_EQ(status.error, error) << frothResultName(status.error);
    EXPECT_EQ(messages_.size(), 1u) << "exactly one message";
    EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
    return status;
  }
};

TEST_F(AssetOfNullContext, OpensAtOnceAndIsReadyAfterAFrame) {
  const std::string path = writeFile("sample.froth", encodeSample());
  const FrothAsset asset = openPath(path);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  EXPECT_EQ(statusOf(asset).cellCount, 0u) << "nothing is read before frothUpdate";
  ASSERT_EQ(update(1), FROTH_OK);
  EXPECT_EQ(frothRecordUpload(context_, nullptr), FROTH_OK);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_THAT(messages_, IsEmpty());
}

TEST_F(AssetOfNullContext, TellsWhatTheManifestHolds) {
  const AssetContents contents = makeSampleAsset({.cellsPerChunk = 9, .detailCount = 3, .lobeCount = 2});
  const std::vector<uint8_t> bytes = encodeSample({.cellsPerChunk = 9, .detailCount = 3, .lobeCount = 2});
  const FrothAsset asset = openBytes(bytes);
  ASSERT_EQ(update(1), FROTH_OK);
  const FrothAssetStatus status = statusOf(asset);
  EXPECT_EQ(status.cellCount, 9u);
  EXPECT_EQ(status.liveCount, 6u);
  EXPECT_EQ(status.detailCount, 3u);
  EXPECT_EQ(status.lobeCount, 2u);
  EXPECT_EQ(status.chunkCount, 1u);
  EXPECT_TRUE(status.hasWalkGraph);
  EXPECT_FLOAT_EQ(status.nearRatio, 3.0f);
  EXPECT_FLOAT_EQ(status.nearDepth, 0.25f);
  EXPECT_EQ(status.deviceBytes, 0u);
  ASSERT_TRUE(status.hasStartView);
  EXPECT_EQ(status.startView.worldFromCamera[11], -3.0);

  for (int axis = 0; axis < 3; ++axis) {
    const ChunkContents& chunk = contents.chunks[0];
    double low = 1e30;
    for (uint32_t i = 0; i < chunk.liveCount; ++i) {
      low = std::min(low, chunk.origin[static_cast<size_t>(axis)] + chunk.sites[i][axis] - chunk.radii[i]);
    }
    EXPECT_FLOAT_EQ(status.boundsMin[axis], static_cast<float>(low));
  }
}

TEST_F(AssetOfNullContext, GivesItsFlightPathUpToTheCallersCapacity) {
  const std::vector<uint8_t> bytes = encodeSample();
  const FrothAsset asset = openBytes(bytes);
  ASSERT_EQ(update(1), FROTH_OK);
  uint32_t count = 0;
  EXPECT_EQ(frothGetFlightPath(context_, asset, 0, nullptr, &count), FROTH_OK);
  EXPECT_EQ(count, 2u);
  FrothStoredCamera cameras[3] = {};
  cameras[1].tanHalfFovY = 99;
  EXPECT_EQ(frothGetFlightPath(context_, asset, 1, cameras, &count), FROTH_OK);
  EXPECT_EQ(cameras[0].tanHalfFovY, 0.5);
  EXPECT_EQ(cameras[1].tanHalfFovY, 99);
  EXPECT_EQ(frothGetFlightPath(context_, asset, 3, cameras, &count), FROTH_OK);
  EXPECT_EQ(cameras[1].tanHalfFovY, 0.75);
  EXPECT_EQ(frothGetFlightPath(context_, asset, 1, nullptr, &count), FROTH_ERROR_ARGUMENT);
}

TEST_F(AssetOfNullContext, GivesItsChunksUpToTheCallersCapacity) {
  const FrothAsset asset = openBytes(encodeSample({.chunkCount = 3, .localBits = 16}));
  uint32_t count = 7;
  EXPECT_EQ(frothGetChunks(context_, asset, 0, nullptr, &count), FROTH_OK);
  EXPECT_EQ(count, 0u) << "its head is not read yet";
  ASSERT_EQ(update(1), FROTH_OK);
  FrothChunk chunks[4] = {};
  chunks[2].level = 99;
  EXPECT_EQ(frothGetChunks(context_, asset, 2, chunks, &count), FROTH_OK);
  EXPECT_EQ(count, 3u);
  EXPECT_EQ(chunks[1].state, FROTH_CHUNK_DRAWN);
  EXPECT_GT(chunks[1].liveCount, 0u);
  EXPECT_EQ(chunks[2].level, 99u);
  EXPECT_EQ(frothGetChunks(context_, asset, 4, chunks, &count), FROTH_OK);
  EXPECT_EQ(chunks[2].level, 0u);
  EXPECT_EQ(frothGetChunks(context_, asset, 1, nullptr, &count), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(lastText(), "chunks: null, with capacity 1");
  EXPECT_EQ(frothGetChunks(context_, asset, 1, chunks, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(lastText(), "count: null");
}

TEST_F(AssetOfNullContext, OfABadChunkHasOnlyFailedChunks) {
  std::vector<uint8_t> bytes = encodeSample({.chunkCount = 3, .localBits = 16});
  bytes.back() ^= 1;
  const FrothAsset asset = openBytes(bytes);
  ASSERT_EQ(update(1), FROTH_OK);
  ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
  FrothChunk chunks[3] = {};
  uint32_t count = 0;
  EXPECT_EQ(frothGetChunks(context_, asset, 3, chunks, &count), FROTH_OK);
  ASSERT_EQ(count, 3u);
  for (const FrothChunk& chunk : chunks) EXPECT_EQ(chunk.state, FROTH_CHUNK_FAILED);
}

TEST_F(AssetOfNullContext, OfAFewSmallChunksDecodesAllInOneFrame) {
  const std::vector<uint8_t> bytes = encodeSample({.chunkCount = 3, .localBits = 16});
  const FrothAsset asset = openBytes(bytes);
  ASSERT_EQ(update(1), FROTH_OK);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(statusOf(asset).cellCount, 18u);
}

TEST_F(AssetOfNullContext, ThatIsMissingFailsWithItsPath) {
  const std::string path = (folder() / "missing.froth").string();
  failedStatus(openPath(path), FROTH_ERROR_FILE);
  EXPECT_EQ(messages_[0].object, path);
  EXPECT_THAT(messages_[0].text, HasSubstr("check the path"));
}

TEST_F(AssetOfNullContext, ThatIsAFolderFails) {
  failedStatus(openPath(folder().string()), FROTH_ERROR_FILE);
  EXPECT_THAT(messages_[0].text, HasSubstr("directory"));
}

TEST_F(AssetOfNullContext, ThatIsTruncatedFailsAtAnyLength) {
  const std::vector<uint8_t> whole = encodeSample();
  for (size_t size = 1; size < whole.size(); size += 97) {
    const std::vector<uint8_t> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const FrothAsset asset = openBytes(part);
    ASSERT_EQ(update(size + 1), FROTH_OK);
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED) << size;
    EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_FILE) << size;
    EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  }
}

TEST_F(AssetOfNullContext, WithADamagedSectionNamesPathSectionAndRemedy) {
  std::vector<uint8_t> bytes = encodeSample();
  bytes.back() ^= 1;
  const std::string path = writeFile("damaged.froth", bytes);
  failedStatus(openPath(path), FROTH_ERROR_FILE);
  EXPECT_EQ(messages_[0].object, path);
  EXPECT_THAT(messages_[0].text, AllOf(HasSubstr("chunk 0"), HasSubstr("section"), HasSubstr("hash")));
}

TEST_F(AssetOfNullContext, OfANewerFormatFailsAsAVersion) {
  std::vector<uint8_t> bytes = encodeSample();
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.versionMajor = 99;
  header.headerHash = hashHeader(header);
  std::memcpy(bytes.data(), &header, sizeof(header));
  const FrothAsset asset = openBytes(bytes);
  ASSERT_EQ(update(1), FROTH_OK);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
  EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_VERSION) << lastText();
}

TEST_F(AssetOfNullContext, FailsAloneBesideAGoodOne) {
  const std::vector<uint8_t> good = encodeSample(), bad(100, 0);
  const FrothAsset badAsset = openBytes(bad), goodAsset = openBytes(good);
  ASSERT_EQ(update(1), FROTH_OK);
  EXPECT_EQ(statusOf(badAsset).state, FROTH_ASSET_FAILED);
  EXPECT_EQ(statusOf(goodAsset).state, FROTH_ASSET_READY);
}

TEST_F(AssetOfNullContext, NeedsAPathOrBytesAndNotBoth) {
  const std::vector<uint8_t> bytes(10);
  auto info = makeStruct<FrothAssetInfo>();
  FrothAsset asset{};
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("none is set"));
  info.path = "x";
  info.data = bytes.data();
  info.dataSize = bytes.size();
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("more than one is set"));
  info.path = nullptr;
  info.dataSize = 0;
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  info.data = nullptr;
  info.path = "";
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
}

TEST_F(AssetOfNullContext, HasNoFourthLayer) {
  const std::vector<uint8_t> bytes = encodeSample();
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes.data();
  info.dataSize = bytes.size();
  info.layers = 4;
  FrothAsset asset{};
  EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), AllOf(HasSubstr("layers: 4"), HasSubstr("at most 3")));
}

TEST_F(AssetOfNullContext, TellsWhatTheLoadedLayersHold) {
  const std::vector<uint8_t> bytes = encodeSample({.detailCount = 3, .lobeCount = 2});
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes.data();
  info.dataSize = bytes.size();
  info.layers = 2;
  FrothAsset asset{};
  ASSERT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK);
  ASSERT_EQ(update(1), FROTH_OK);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY) << lastText();
  EXPECT_EQ(statusOf(asset).detailCount, 3u);
  EXPECT_EQ(statusOf(asset).lobeCount, 0u);
}

TEST_F(AssetOfNullContext, KeepsItsPathWhenTheCallersStringIsGone) {
  auto path = std::make_unique<std::string>(writeFile("sample.froth", encodeSample()));
  const FrothAsset asset = openPath(*path);
  path.reset();
  ASSERT_EQ(update(1), FROTH_OK);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY) << lastText();
}

// An update ends behind the chunk that exceeds its work, of all assets together; a chunk of one cell counts as the
// least.
TEST_F(AssetOfNullContext, OfManySmallChunksIsDecodedInSlices) {
  const std::vector<uint8_t> bytes = *encodeAsset(makeOneCellChunks(300));
  const FrothAsset first = openBytes(bytes), second = openBytes(bytes);
  const auto isOpening = [&](FrothAsset asset) { return statusOf(asset).state == FROTH_ASSET_OPENING; };
  uint64_t updates = 0;
  std::vector<uint64_t> readyAt;
  for (const FrothAsset asset : {first, second}) {
    while (isOpening(asset) && updates < 10) ASSERT_EQ(update(++updates), FROTH_OK);
    readyAt.push_back(updates);
  }
  EXPECT_EQ(readyAt, (std::vector<uint64_t>{2, 3})) << "256 chunks in an update";
}

}  // namespace
}  // namespace froth
