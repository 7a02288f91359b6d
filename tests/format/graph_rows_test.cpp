// Packed graphs: rows come back as they were, and any other bytes are refused or give rows that hold.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec_samples.h"
#include "format/graph_rows.h"

namespace froth {
namespace {

using testing::HasSubstr;

// What a reader has before it reads the graph.
ChunkContents withoutRows(ChunkContents chunk) {
  chunk.neighbourOffsets.clear();
  chunk.neighbours.clear();
  chunk.alphaCounts.clear();
  return chunk;
}

Status unpack(const PackedGraph& packed, bool hasWalkGraph, ChunkContents& chunk) {
  return unpackGraph({packed.counts, packed.deltas, packed.alphaBits}, hasWalkGraph, chunk, "here");
}

void expectRoundTrip(const ChunkContents& chunk, bool hasWalkGraph) {
  const Result<PackedGraph> packed = packGraph(chunk, hasWalkGraph);
  ASSERT_TRUE(packed) << packed.error().message;
  EXPECT_EQ(packed->alphaBits.empty(), !hasWalkGraph);
  ChunkContents decoded = withoutRows(chunk);
  const Status status = unpack(*packed, hasWalkGraph, decoded);
  ASSERT_TRUE(status) << status.error().message;
  EXPECT_EQ(decoded.neighbourOffsets, chunk.neighbourOffsets);
  EXPECT_EQ(decoded.neighbours, chunk.neighbours);
  EXPECT_EQ(decoded.alphaCounts, chunk.alphaCounts);
}

TEST(GraphRows, ComeBackAsTheyWere) {
  for (const uint32_t cells : {2u, 3u, 16u, 1000u}) {
    expectRoundTrip(randomGraph(cells, true), true);
    expectRoundTrip(randomGraph(cells, false), false);
  }
}

TEST(GraphRows, OfAHubAndOfWideIndicesComeBack) {
  // A hub: cell 0 and all others.       0 -- 1, 0 -- 2, 0 -- 3 ...
  ChunkContents hub;
  hub.cellCount = hub.liveCount = 40000;
  hub.neighbourOffsets = {0};
  for (uint32_t i = 0; i < hub.cellCount; ++i) {
    hub.sites.emplace_back(static_cast<float>(i), 0.0f, 0.0f);
    hub.radii.push_back(1.0f);
    if (i > 0) hub.neighbours.push_back(i);
  }
  hub.neighbourOffsets.push_back(hub.cellCount - 1);
  for (uint32_t i = 1; i < hub.cellCount; ++i) {
    hub.neighbours.push_back(0);
    hub.neighbourOffsets.push_back(hub.neighbourOffsets.back() + 1);
  }
  hub.alphaCounts.assign(hub.cellCount, 0);
  EXPECT_EQ(graphElementSize(hub), 4u);
  expectRoundTrip(hub, true);
}

TEST(GraphRows, AreSortedNearestPlaneFirst) {
  // Planes at distance 1, 3, -1 of cell 0:    2 <-- 0 --> 1 --> 3
  ChunkContents chunk;
  chunk.cellCount = 1;
  chunk.ghostCount = 3;
  chunk.liveCount = 1;
  chunk.sites = {{0, 0, 0}, {2, 0, 0}, {-4, 0, 0}, {6, 0, 0}};
  chunk.radii = {1, 1, 5, 1};
  chunk.neighbourOffsets = {0, 3};
  chunk.neighbours = {3, 1, 2};
  chunk.alphaCounts = {1};
  sortGraphRows(chunk, 0, 1);
  EXPECT_THAT(chunk.neighbours, testing::ElementsAre(3, 2, 1));
  EXPECT_DOUBLE_EQ(planeDistance(chunk, 0, 1), 1);
  EXPECT_DOUBLE_EQ(planeDistance(chunk, 0, 2), -1);
}

TEST(GraphRows, ThatAreNotMutualAreNotPacked) {
  ChunkContents chunk = randomGraph(50, true);
  ChunkContents selfish = chunk, repeated = chunk, oneSided = chunk;
  selfish.neighbours[chunk.neighbourOffsets[3]] = 3;
  EXPECT_FALSE(packGraph(selfish, true));
  repeated.neighbours[chunk.neighbourOffsets[3]] = repeated.neighbours[chunk.neighbourOffsets[3] + 1];
  EXPECT_FALSE(packGraph(repeated, true));
  for (uint32_t& offset : oneSided.neighbourOffsets) offset = std::min(offset, chunk.neighbourOffsets[49]);
  EXPECT_FALSE(packGraph(oneSided, true));
}

TEST(HostileGraph, OfWrongSizesIsRefused) {
  const ChunkContents chunk = randomGraph(40, true);
  const PackedGraph packed = *packGraph(chunk, true);
  for (std::vector<uint8_t> PackedGraph::*part :
       {&PackedGraph::counts, &PackedGraph::deltas, &PackedGraph::alphaBits}) {
    for (size_t size = 0; size < (packed.*part).size() + 4; ++size) {
      if (size == (packed.*part).size()) continue;
      PackedGraph changed = packed;
      (changed.*part).resize(size);
      ChunkContents decoded = withoutRows(chunk);
      EXPECT_FALSE(unpack(changed, true, decoded)) << size;
    }
  }
}

// A hub of `spokes` cells, as packed: all deltas are 0.
Status unpackHub(uint32_t spokes) {
  ChunkContents chunk;
  chunk.cellCount = spokes + 1;
  chunk.sites.resize(chunk.cellCount, glm::vec3(1));
  chunk.radii.resize(chunk.cellCount, 1.0f);
  std::vector<uint32_t> counts(chunk.cellCount, 0), deltas(spokes, 0);
  counts[0] = spokes;
  const std::vector<uint8_t> bits((spokes + 7) / 8, 0);
  return unpackGraph({bytesOf(counts), bytesOf(deltas), bits}, true, chunk, "here");
}

TEST(HostileGraph, WithMoreNeighboursThanASiteMayHaveIsRefused) {
  const Status most = unpackHub(kMaxNeighbours);
  EXPECT_TRUE(most) << most.error().message;
  const Status more = unpackHub(kMaxNeighbours + 1);
  ASSERT_FALSE(more);
  EXPECT_THAT(more.error().message, HasSubstr("here: graph: site 0 has more than 65535 neighbours"));
}

// Each of the first cells is a neighbour of all others.
TEST(HostileGraph, WithMoreHubsThanTheLimitOfSquaredDegreesIsRefused) {
  constexpr uint32_t kCells = 20'000;
  const auto unpackHubs = [](uint32_t hubs) {
    ChunkContents chunk;
    chunk.cellCount = kCells;
    chunk.sites.resize(kCells, glm::vec3(1));
    chunk.radii.resize(kCells, 1.0f);
    std::vector<uint16_t> counts(kCells, 0), deltas;
    for (uint32_t hub = 0; hub < hubs; ++hub) counts[hub] = static_cast<uint16_t>(kCells - 1 - hub);
    for (uint32_t hub = 0; hub < hubs; ++hub) deltas.insert(deltas.end(), counts[hub], 0);
    const std::vector<uint8_t> bits((deltas.size() + 7) / 8, 0);
    return unpackGraph({bytesOf(counts), bytesOf(deltas), bits}, true, chunk, "here");
  };
  const uint64_t most = mostSquaredDegrees(kCells) / (uint64_t{kCells} * kCells);  // 10: hubs that may be, nearly
  EXPECT_TRUE(unpackHubs(static_cast<uint32_t>(most)));
  const Status more = unpackHubs(static_cast<uint32_t>(most) + 1);
  ASSERT_FALSE(more);
  EXPECT_THAT(more.error().message, HasSubstr("the squares of the sites' degrees add up to more than"));
}

TEST(GraphRows, OfACellWithTooManyNeighboursAreNotPacked) {
  ChunkContents hub;
  hub.cellCount = 1;
  hub.ghostCount = kMaxNeighbours + 1;
  hub.sites.resize(1 + hub.ghostCount, glm::vec3(1));
  hub.radii.resize(1 + hub.ghostCount, 1.0f);
  for (uint32_t i = 1; i <= hub.ghostCount; ++i) hub.neighbours.push_back(i);
  hub.neighbourOffsets = {0, hub.ghostCount};
  const Result<PackedGraph> packed = packGraph(hub, true);
  ASSERT_FALSE(packed);
  EXPECT_THAT(packed.error().message, HasSubstr("site 0 has more than 65535 neighbours"));
}

TEST(HostileGraph, WithAPairBeyondTheSitesOrOfTheWrongKindIsRefused) {
  const ChunkContents chunk = randomGraph(40, true);
  const PackedGraph packed = *packGraph(chunk, true);
  ChunkContents decoded = withoutRows(chunk);
  PackedGraph far = packed;
  far.deltas[1] = 0x70;
  EXPECT_THAT(unpack(far, true, decoded).error().message, HasSubstr(">= 60"));
  PackedGraph spare = packed;
  if (packed.deltas.size() / 2 % 8 != 0) {
    spare.alphaBits.back() |= 0x80;
    EXPECT_THAT(unpack(spare, true, decoded).error().message, HasSubstr("spare"));
  }
  PackedGraph dead = packed;
  for (uint8_t& byte : dead.alphaBits) byte = static_cast<uint8_t>(~byte);
  EXPECT_FALSE(unpack(dead, true, decoded));
}

TEST(HostileGraph, WithAnyFlippedBitIsRefusedOrHasRowsThatHold) {
  const ChunkContents chunk = randomGraph(20, true);
  const PackedGraph packed = *packGraph(chunk, true);
  for (std::vector<uint8_t> PackedGraph::*part :
       {&PackedGraph::counts, &PackedGraph::deltas, &PackedGraph::alphaBits}) {
    for (size_t bit = 0; bit < (packed.*part).size() * 8; ++bit) {
      PackedGraph changed = packed;
      (changed.*part)[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
      ChunkContents decoded = withoutRows(chunk);
      EXPECT_TRUE(!unpack(changed, true, decoded) || packGraph(decoded, true)) << bit;
    }
  }
}

TEST(HostileGraph, WithSitesThatAreNoNumbersStillEnds) {
  ChunkContents chunk = randomGraph(60, true);
  const PackedGraph packed = *packGraph(chunk, true);
  for (size_t i = 0; i < chunk.sites.size(); i += 3) chunk.sites[i] = glm::vec3(NAN);
  ChunkContents decoded = withoutRows(chunk);
  (void)unpack(packed, true, decoded);
}

}  // namespace
}  // namespace froth
