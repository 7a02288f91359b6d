// Many frames of random views, budgets, delays and failures: what must hold in each of them, and where they end.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "tests/stream/level_dag.h"
#include "tests/stream/simulated_owner.h"

namespace froth::test {
namespace {

constexpr uint32_t kFramesOfFlight = 800;
constexpr uint32_t kMostFramesToSettle = 4000;

// Assets, and what eyes and budget end as, for a seed.
struct World {
  std::vector<LevelDag> dags;
  std::vector<LevelGraph> graphs;
  std::vector<std::vector<StreamEye>> lastEyes;
  uint64_t floorBytes = 0, allBytes = 0, lastBudget = 0;
  std::vector<ChunkId> broken;

  explicit World(uint64_t seed) : random(seed) {
    const uint32_t count = pick(1, 3);
    for (uint32_t i = 0; i < count; ++i) {
      dags.push_back(makeLevelDag(seed * 8 + i, {pick(0, 20) == 0 ? 250 : pick(1, 60), pick(1, 4), pick(3, 6)}));
      graphs.push_back(dags.back().graph());
      lastEyes.push_back(eyesOf(i));
      floorBytes += graphs.back().floorBytes();
      for (const uint64_t bytes : dags.back().bytes) allBytes += bytes;
      if (pick(0, 1) == 0) breakOne(i);
    }
    lastBudget = budget();
  }

  uint32_t pick(uint32_t low, uint32_t high) { return std::uniform_int_distribution<uint32_t>(low, high)(random); }
  std::vector<StreamEye> eyesOf(uint32_t asset) {
    std::vector<StreamEye> eyes;
    for (uint32_t i = pick(0, 2); i-- > 0;) eyes.push_back(makeEye(random(), dags[asset]));
    return eyes;
  }
  uint64_t budget() { return floorBytes + (allBytes - floorBytes) * pick(0, 40) / 40; }
  void breakOne(uint32_t asset) {
    const uint32_t chunk = pick(0, graphs[asset].chunkCount() - 1);
    if (graphs[asset].chunk(chunk).in != kNoGroup) broken.push_back({asset, chunk});
  }

  std::mt19937_64 random;
};

SimulatedOwner makeOwner(const World& world, const OwnerOptions& options) {
  SimulatedOwner owner(options);
  owner.setBudget(world.allBytes);
  for (uint32_t asset = 0; asset < world.graphs.size(); ++asset) {
    owner.addAsset(world.graphs[asset]);
    EXPECT_TRUE(owner.streamer.placeAsset(asset));
  }
  for (const ChunkId id : world.broken) owner.breakChunk(id);
  return owner;
}

void fly(World& world, SimulatedOwner& owner) {
  std::vector<std::vector<StreamEye>> eyes(world.graphs.size());
  for (uint32_t frame = 0; frame < kFramesOfFlight; ++frame) {
    for (uint32_t asset = 0; asset < world.graphs.size(); ++asset) {
      for (StreamEye& eye : eyes[asset]) eye.position.x += 0.02;
      if (world.pick(0, 60) == 0) eyes[asset] = world.eyesOf(asset);
      if (world.pick(0, 300) == 0) owner.streamer.unplaceAsset(asset);
      if (world.pick(0, 50) == 0) {
        EXPECT_TRUE(owner.streamer.placeAsset(asset));
      }
      owner.streamer.setEyes(asset, eyes[asset]);
    }
    if (world.pick(0, 100) == 0) owner.setBudget(world.budget());
    owner.runFrame();
  }
}

void comeToRest(World& world, SimulatedOwner& owner) {
  owner.setBudget(world.lastBudget);
  for (uint32_t asset = 0; asset < world.graphs.size(); ++asset) {
    EXPECT_TRUE(owner.streamer.placeAsset(asset));
    owner.streamer.setEyes(asset, world.lastEyes[asset]);
  }
  EXPECT_LT(owner.settle(kMostFramesToSettle), kMostFramesToSettle);
}

void leave(World& world, SimulatedOwner& owner) {
  for (uint32_t asset = 0; asset < world.graphs.size(); ++asset) owner.streamer.removeAsset(asset);
  for (int frame = 0; frame < 20; ++frame) owner.runFrame();
  EXPECT_EQ(owner.heldBytes(), 0);
  for (uint32_t asset = 0; asset < world.graphs.size(); ++asset) EXPECT_FALSE(owner.streamer.hasAsset(asset));
  for (const StateTotals& totals : owner.streamer.statistics().states) EXPECT_EQ(totals.chunks, 0);
}

struct Flown {
  std::vector<ChunkId> drawn;
  uint64_t digest = 0;
  uint32_t frames = 0;
};

Flown flyWhole(uint64_t seed) {
  World world(seed);
  SimulatedOwner owner = makeOwner(world, {.seed = seed, .mostDelay = world.pick(0, 6), .failureShare = 0.1});
  fly(world, owner);
  comeToRest(world, owner);
  Flown flown{owner.drawnChunks(), owner.digest()};
  leave(world, owner);
  EXPECT_EQ(owner.violation(), "") << "seed " << seed;
  flown.frames = owner.frames();
  return flown;
}

// FROTH_STREAM_SEEDS: flights of the long test; 1,200 if it is not set, more than a million frames.
uint64_t seedCount() {
  const char* text = std::getenv("FROTH_STREAM_SEEDS");
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 1200;
}

TEST(Flight, ShowsACutOfResidentChunksWithinTheBudgetAndEndsWhereAFreshStartEnds) {
  uint64_t drawn = 0, frames = 0;
  for (uint64_t seed = 1; seed <= seedCount() && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Flown flown = flyWhole(seed);
    World world(seed);
    SimulatedOwner fresh = makeOwner(world, {.seed = seed + 1, .mostDelay = 0, .failureShare = 0});
    comeToRest(world, fresh);
    EXPECT_EQ(flown.drawn, fresh.drawnChunks());
    drawn += flown.drawn.size();
    frames += flown.frames;
  }
  EXPECT_GT(drawn, 10 * seedCount());
  std::cout << frames << " frames\n";
}

// Without failures, eyes and budgets that change, a step towards the wanted cut needs no step back.
TEST(Flight, OnlySharpensFromAFreshStart) {
  for (uint64_t seed = 1; seed <= 200 && !testing::Test::HasFailure(); ++seed) {
    World world(seed);
    world.broken.clear();
    SimulatedOwner owner = makeOwner(world, {.seed = seed, .failureShare = 0});
    owner.setBudget(world.lastBudget);
    std::vector<std::vector<uint32_t>> refined(world.graphs.size());
    for (uint32_t asset = 0; asset < refined.size(); ++asset) owner.streamer.setEyes(asset, world.lastEyes[asset]);
    for (bool isSettled = false; !isSettled && owner.frames() < kMostFramesToSettle; isSettled = owner.settle(1) == 0) {
      for (uint32_t asset = 0; asset < refined.size(); ++asset) {
        const GroupSet& now = owner.streamer.refined(asset);
        for (const uint32_t group : refined[asset]) EXPECT_TRUE(now.contains(group)) << "seed " << seed;
        refined[asset].assign(now.members().begin(), now.members().end());
      }
    }
    EXPECT_TRUE(owner.streamer.isSettled()) << "seed " << seed;
  }
}

TEST(Flight, IsTheSameEachTime) {
  for (uint64_t seed = 1; seed <= 5; ++seed) EXPECT_EQ(flyWhole(seed).digest, flyWhole(seed).digest);
}

}  // namespace
}  // namespace froth::test
