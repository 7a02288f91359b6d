// The greatest and the least whole cut against all cuts of small assets.
#include "runtime/stream/cuts.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/stream/level_dag.h"

namespace froth::test {
namespace {

constexpr uint32_t kMostGroups = 14;

GroupSet makeSet(const LevelGraph& graph, uint32_t bits) {
  GroupSet set(graph.groupCount());
  for (uint32_t g = 0; g < graph.groupCount(); ++g) {
    if (bits >> g & 1) set.add(g);
  }
  return set;
}

uint32_t bitsOf(const GroupSet& set) {
  uint32_t bits = 0;
  for (const uint32_t group : set.members()) bits |= 1u << group;
  return bits;
}

bool isCut(const LevelGraph& graph, const GroupSet& set) {
  for (const uint32_t group : set.members()) {
    for (const uint32_t coarser : graph.coarserThan(group)) {
      if (!set.contains(coarser)) return false;
    }
  }
  return true;
}

bool isWhole(const LevelGraph& graph, const GroupSet& cut, const std::vector<bool>& isAvailable) {
  for (uint32_t chunk = 0; chunk < graph.chunkCount(); ++chunk) {
    if (isDrawnIn(cut, graph.chunk(chunk)) && !isAvailable[chunk]) return false;
  }
  return true;
}

struct Case {
  LevelGraph graph;
  std::vector<bool> isAvailable;
  std::vector<uint32_t> cuts, wholeCuts;

  Case(uint64_t seed, double share) : graph(makeLevelDag(seed, {14, 2, 5}).graph()) {
    std::mt19937_64 random(seed);
    for (uint32_t chunk = 0; chunk < graph.chunkCount(); ++chunk) {
      isAvailable.push_back(graph.chunk(chunk).in == kNoGroup ||
                            std::uniform_real_distribution<double>()(random) < share);
    }
    for (uint32_t bits = 0; bits < 1u << graph.groupCount(); ++bits) {
      const GroupSet set = makeSet(graph, bits);
      if (!isCut(graph, set)) continue;
      cuts.push_back(bits);
      if (isWhole(graph, set, isAvailable)) wholeCuts.push_back(bits);
    }
  }
};

TEST(Cuts, TheGreatestWholeCutInsideACutHoldsAllOthers) {
  std::vector<uint32_t> dropped;
  size_t between = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const Case of(seed, 0.8);
    ASSERT_LE(of.graph.groupCount(), kMostGroups);
    for (size_t i = 0; i < of.cuts.size(); i += 1 + of.cuts.size() / 50) {
      GroupSet cut = makeSet(of.graph, of.cuts[i]);
      uint32_t best = 0;  // the union of all: it is one of them
      for (const uint32_t whole : of.wholeCuts) best |= (whole & ~of.cuts[i]) == 0 ? whole : 0;
      shrinkToWhole(
          of.graph, [&](uint32_t chunk) { return of.isAvailable[chunk]; }, cut, dropped);
      ASSERT_EQ(bitsOf(cut), best) << "seed " << seed;
      ASSERT_TRUE(isWhole(of.graph, cut, of.isAvailable));
      between += best != 0 && best != of.cuts[i];
    }
  }
  EXPECT_GT(between, 100);
}

TEST(Cuts, TheLeastWholeCutAroundACutIsInAllOthers) {
  size_t grown = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const Case of(seed, 0.8);
    for (size_t i = 0; i < of.cuts.size(); i += 1 + of.cuts.size() / 50) {
      uint32_t best = UINT32_MAX;
      for (const uint32_t whole : of.wholeCuts) best &= (of.cuts[i] & ~whole) == 0 ? whole : UINT32_MAX;
      if (best == UINT32_MAX) continue;  // none is whole
      GroupSet cut = makeSet(of.graph, of.cuts[i]);
      growToWhole(
          of.graph, [&](uint32_t chunk) { return of.isAvailable[chunk]; }, cut);
      ASSERT_EQ(bitsOf(cut), best) << "seed " << seed;
      ASSERT_TRUE(isWhole(of.graph, cut, of.isAvailable));
      grown += best != of.cuts[i];
    }
  }
  EXPECT_GT(grown, 100);
}

}  // namespace
}  // namespace froth::test
