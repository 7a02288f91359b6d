// What frothGetChunks tells of the chunks of an asset.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/levels/streamed.h"

namespace froth::test {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

std::vector<uint32_t> chunksIn(FrothChunkState state, const std::vector<FrothChunk>& chunks) {
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < chunks.size(); ++i) {
    if (chunks[i].state == state) found.push_back(i);
  }
  return found;
}

uint64_t bytesOnDevice(const std::vector<FrothChunk>& chunks) {
  uint64_t bytes = 0;
  for (const FrothChunk& chunk : chunks) {
    if (chunk.state == FROTH_CHUNK_RESIDENT || chunk.state == FROTH_CHUNK_DRAWN) bytes += chunk.deviceBytes;
  }
  return bytes;
}

// Of the arrays of all chunks.
uint64_t namedBytes(const FrothAssetStatus& status) {
  uint64_t bytes = 0;
  for (uint32_t i = 0; i < status.memoryCount; ++i) {
    const std::string name = status.memory[i].name;
    if (name != "table of borders" && name != "alignment, spare") bytes += status.memory[i].bytes;
  }
  return bytes;
}

TEST(Chunks, HaveTheLevelAndTheErrorsOfTheFile) {
  Reader reader;
  Streamed streamed(reader);
  EXPECT_TRUE(streamed.chunks().empty()) << "its head is not read yet";
  streamed.settle(kFar);
  const std::vector<FrothChunk> chunks = streamed.chunks();
  const AssetContents& sample = levelSample();
  ASSERT_EQ(chunks.size(), sample.chunks.size());
  for (size_t i = 0; i < chunks.size(); ++i) {
    const ChunkLevel& level = sample.levels[i];
    EXPECT_EQ(chunks[i].level, level.level) << i;
    EXPECT_EQ(chunks[i].error, level.madeBy == kNoGroup ? 0 : sample.groups[level.madeBy].error) << i;
    EXPECT_EQ(chunks[i].coarserError, level.in == kNoGroup ? kNone : sample.groups[level.in].error) << i;
    EXPECT_LT(chunks[i].error, chunks[i].coarserError) << i;
    EXPECT_EQ(chunks[i].liveCount, sample.chunks[i].liveCount) << i;
  }
}

TEST(Chunks, HaveABallAroundTheBallsOfTheirLiveCells) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kFar);
  const std::vector<FrothChunk> chunks = streamed.chunks();
  for (size_t i = 0; i < chunks.size(); ++i) {
    const ChunkContents& contents = levelSample().chunks[i];
    const glm::dvec3 centre(chunks[i].centre[0], chunks[i].centre[1], chunks[i].centre[2]);
    const glm::dvec3 origin(contents.origin[0], contents.origin[1], contents.origin[2]);
    glm::dvec3 low(kNone), high(-kNone);
    for (uint32_t cell = 0; cell < contents.liveCount; ++cell) {
      const glm::dvec3 site = origin + glm::dvec3(contents.sites[cell]);
      const double radius = contents.radii[cell];
      EXPECT_LE(glm::length(site - centre) + radius, chunks[i].radius * (1 + 1e-6)) << i;
      low = glm::min(low, site - radius);
      high = glm::max(high, site + radius);
    }
    EXPECT_NEAR(chunks[i].radius, glm::length(high - low) / 2, 1e-5) << i;
    EXPECT_LT(glm::length(centre - (low + high) / 2.0), 1e-5) << i;
  }
}

TEST(Chunks, AreDrawnAndResidentAsTheStreamSays) {
  Reader reader;
  Streamed streamed(reader);
  size_t coming = 0;
  for (const double distance : {kFar, kNear, kBetween, kFar}) {
    for (int frame = 0; frame < 12; ++frame) {
      streamed.frame(distance);
      const std::vector<FrothChunk> chunks = streamed.chunks();
      EXPECT_EQ(chunksIn(FROTH_CHUNK_DRAWN, chunks), streamed.isReady() ? streamed.drawn() : std::vector<uint32_t>());
      coming += chunksIn(FROTH_CHUNK_COMING, chunks).size();
    }
    streamed.settle(distance);
    const std::vector<FrothChunk> chunks = streamed.chunks();
    const size_t drawn = chunksIn(FROTH_CHUNK_DRAWN, chunks).size();
    EXPECT_EQ(drawn, streamed.status().drawnChunks);
    EXPECT_EQ(drawn + chunksIn(FROTH_CHUNK_RESIDENT, chunks).size(), streamed.status().residentChunks);
    EXPECT_EQ(chunksIn(FROTH_CHUNK_COMING, chunks).size(), streamed.status().comingChunks);
  }
  EXPECT_GT(coming, 0u);
}

// Arrays within a chunk are aligned, which the names do not count.
TEST(Chunks, TakeTheBytesThatTheAssetHasOnTheDevice) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kFar);
  const std::vector<FrothChunk> before = streamed.chunks();
  streamed.settle(kNear);
  const std::vector<FrothChunk> after = streamed.chunks();
  const FrothAssetStatus status = streamed.assetStatus();
  EXPECT_GE(bytesOnDevice(after), namedBytes(status));
  EXPECT_LE(bytesOnDevice(after), namedBytes(status) * 11 / 10);
  EXPECT_LT(bytesOnDevice(before), bytesOnDevice(after));
  for (const uint32_t chunk : floorCut()) EXPECT_EQ(before[chunk].deviceBytes, after[chunk].deviceBytes) << chunk;
  for (const uint32_t chunk : finestCut()) {
    EXPECT_GT(before[chunk].deviceBytes, after[chunk].deviceBytes / 2) << chunk;
    EXPECT_LT(before[chunk].deviceBytes, after[chunk].deviceBytes * 2) << chunk;
  }
}

TEST(Chunks, WithoutLevelsAreAllDrawn) {
  Stage stage(bakeForTest(*foamFromAsset(contentsOf(finestCut()))), {8, 8});
  std::vector<FrothChunk> chunks(9);
  uint32_t count = 0;
  check(frothGetChunks(stage.context(), stage.asset(), 9, chunks.data(), &count), "frothGetChunks");
  chunks.resize(count);
  ASSERT_EQ(count, stage.assetStatus().chunkCount);
  uint32_t cells = 0;
  for (const FrothChunk& chunk : chunks) {
    EXPECT_EQ(chunk.state, FROTH_CHUNK_DRAWN);
    EXPECT_EQ(chunk.level, 0u);
    EXPECT_EQ(chunk.error, 0);
    EXPECT_EQ(chunk.coarserError, kNone);
    cells += chunk.liveCount;
  }
  EXPECT_EQ(cells, stage.assetStatus().liveCount);
  EXPECT_GE(bytesOnDevice(chunks), namedBytes(stage.assetStatus()));
  EXPECT_LE(bytesOnDevice(chunks), stage.assetStatus().deviceBytes);
}

TEST(Streaming, FreezesWhatIsWantedWhileViewsMove) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kNear);
  auto info = makeStruct<FrothStreamInfo>();
  info.isFrozen = 1;
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), finestCut());
  info.mostCells = 1;  // goes on counting
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), floorCut());
  info.mostCells = 0;
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), finestCut());
  info.isFrozen = 0;
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), floorCut());
}

}  // namespace
}  // namespace froth::test
