// The selection against its definition, by brute force.
#include "runtime/stream/selection.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/stream/level_dag.h"

namespace froth::test {
namespace {

constexpr uint64_t kUnlimited = UINT64_MAX;

struct Scene {
  std::vector<LevelDag> dags;
  std::vector<LevelGraph> graphs;
  std::vector<AssetDemand> demands;

  Scene(uint64_t seed, size_t count) {
    for (size_t i = 0; i < count; ++i) dags.push_back(makeLevelDag(seed * 10 + i, {20, 2, 4}));
    for (const LevelDag& dag : dags) graphs.push_back(dag.graph());
    for (size_t i = 0; i < count; ++i) {
      AssetDemand demand{&graphs[i], {makeEye(seed * 100 + i, dags[i]), makeEye(seed * 200 + i, dags[i])}, {}};
      demand.wanted = GroupSet(graphs[i].groupCount());
      demands.push_back(demand);
    }
  }
  std::vector<GroupId> select(uint64_t bytes, uint64_t cells) {
    Selection selection;
    selection.select(demands, {bytes, cells});
    return {selection.bought().begin(), selection.bought().end()};
  }
};

// All groups whose key is 1 or more sorted by rank, the coarser first where ranks are equal.
std::vector<GroupId> sortedByRank(const Scene& scene) {
  struct Entry {
    Wish wish;
    uint32_t level;
    GroupId id;
  };
  std::vector<Entry> entries;
  for (uint32_t a = 0; a < scene.graphs.size(); ++a) {
    for (uint32_t g = 0; g < scene.graphs[a].groupCount(); ++g) {
      entries.push_back(
          {wishFor(scene.graphs[a].group(g), scene.demands[a].eyes), scene.dags[a].groups[g].level, {a, g}});
    }
  }
  std::ranges::sort(entries, [](const Entry& x, const Entry& y) {
    return x.wish.rank != y.wish.rank ? x.wish.rank > y.wish.rank : x.level > y.level;
  });
  std::vector<GroupId> order;
  for (const Entry& entry : entries) {
    if (entry.wish.key >= 1) order.push_back(entry.id);
  }
  return order;
}

// Bytes or cells of what a cut draws, beyond the floor in the case of bytes: it stays resident.
uint64_t weigh(const LevelGraph& graph, const GroupSet& cut, bool isBytes) {
  uint64_t sum = 0;
  for (uint32_t i = 0; i < graph.chunkCount(); ++i) {
    const LevelGraph::Chunk& chunk = graph.chunk(i);
    if (!isDrawnIn(cut, chunk) || (isBytes && chunk.in == kNoGroup)) continue;
    sum += isBytes ? chunk.bytes : chunk.cells;
  }
  return sum;
}

TEST(Selection, BuysGroupsInTheOrderOfTheirRanksUntilOneIsNotAffordable) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    Scene scene(seed, 3);
    const std::vector<GroupId> order = sortedByRank(scene);
    for (const uint64_t bytes : {uint64_t{0}, uint64_t{500}, uint64_t{1500}, uint64_t{3000}, kUnlimited}) {
      for (const uint64_t cells : {uint64_t{60}, uint64_t{150}, kUnlimited}) {
        size_t affordable = 0;
        for (uint64_t usedBytes = 0, usedCells = 0; affordable < order.size(); ++affordable) {
          const auto& group = scene.graphs[order[affordable].asset].group(order[affordable].group);
          usedBytes += group.bytePrice;
          usedCells += group.cellPrice;
          if (usedBytes > bytes || usedCells > cells) break;
        }
        const std::vector<GroupId> bought = scene.select(bytes, cells);
        ASSERT_EQ(bought.size(), affordable) << "seed " << seed << ", bytes " << bytes << ", cells " << cells;
        for (size_t i = 0; i < bought.size(); ++i) {
          EXPECT_EQ(bought[i].asset, order[i].asset);
          EXPECT_EQ(bought[i].group, order[i].group);
        }
      }
    }
  }
}

TEST(Selection, IsACutWithinTheBudgetWhateverIsGiven) {
  size_t refined = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    Scene scene(seed, 2);
    for (const uint64_t limit : {uint64_t{100}, uint64_t{400}, uint64_t{1000}}) {
      refined += scene.select(limit, limit / 2).size();
      uint64_t bytes = 0, cells = 0;
      for (const AssetDemand& demand : scene.demands) {
        bytes += weigh(*demand.graph, demand.wanted, true);
        cells += weigh(*demand.graph, demand.wanted, false) - demand.graph->floorCells();
        for (const uint32_t group : demand.wanted.members()) {
          for (const uint32_t coarser : demand.graph->coarserThan(group)) EXPECT_TRUE(demand.wanted.contains(coarser));
        }
      }
      EXPECT_LE(bytes, limit);
      EXPECT_LE(static_cast<int64_t>(cells), static_cast<int64_t>(limit / 2));
    }
  }
  EXPECT_GT(refined, 500);
}

// A budget of views says the same as one of cells, if each cell has the same price; and cells of an asset that more
// views show cost more.
TEST(Selection, PaysForCellsByWhatViewsNeed) {
  size_t cheaper = 0, dearer = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    Scene scene(seed, 2);
    const size_t byCells = scene.select(kUnlimited, 100).size();
    for (AssetDemand& demand : scene.demands) demand.viewBytesPerCell = 7;
    Selection selection;
    selection.select(scene.demands, {.viewBytes = 7 * 100 + 6});
    ASSERT_EQ(selection.bought().size(), byCells) << "seed " << seed;
    cheaper += byCells;
    scene.demands[1].viewBytesPerCell = 14;
    selection.select(scene.demands, {.viewBytes = 7 * 100 + 6});
    dearer += selection.bought().size();
  }
  EXPECT_LT(dearer, cheaper);
}

TEST(Selection, WantsTheFloorWithoutEyesAndAllWhereAnEyeIsInside) {
  Scene scene(1, 1);
  scene.demands[0].eyes.clear();
  EXPECT_TRUE(scene.select(kUnlimited, kUnlimited).empty());
  scene.demands[0].eyes = {{{3, 3, 0}, 100, 1e-3, 0, 1}};
  EXPECT_EQ(scene.select(kUnlimited, kUnlimited).size(), scene.graphs[0].groupCount());
  scene.demands[0].eyes[0].detail = 0;
  EXPECT_TRUE(scene.select(kUnlimited, kUnlimited).empty());
}

// The bounds are 5 from an eye, 3 for the eye that may move by 2.
TEST(Selection, MeasuresTheErrorByThePixelAtTheNearestPointOfTheBounds) {
  LevelGraph::Group group;
  group.bounds = {{-2, -2, 5}, {2, 2, 15}};
  group.error = 0.6;
  const StreamEye still{{0, 0, 0}, 0, 0.01, 0, 1}, wandering{{0, 0, 0}, 2, 0.01, 0, 1}, flat{{0, 0, 0}, 0, 0, 0.3, 1};
  const StreamEye detailed{{0, 0, 0}, 0, 0.01, 0, 2}, nearBound{{0, 1, 6}, 0, 0.01, 0.002, 1};
  EXPECT_DOUBLE_EQ(wishFor(group, std::vector{still}).key, 0.6 / 0.05);
  EXPECT_DOUBLE_EQ(wishFor(group, std::vector{wandering}).key, 0.6 / 0.03);
  EXPECT_DOUBLE_EQ(wishFor(group, std::vector{flat}).key, 0.6 / 0.3);
  EXPECT_DOUBLE_EQ(wishFor(group, std::vector{detailed}).key, 2 * 0.6 / 0.05);
  EXPECT_DOUBLE_EQ(wishFor(group, std::vector{nearBound}).key, 0.6 / 0.002);
  EXPECT_DOUBLE_EQ(wishFor(group, std::vector{flat, wandering, still}).key, 0.6 / 0.03);
}

// Two walls of a room, each a group, and an eye between them: in both balls, in no box.
//
//    |     o     |
//    0     5    10   x
struct TwoWalls {
  LevelGraph graph;

  explicit TwoWalls(double leftError) {
    const std::vector<ChunkLevel> levels{{1, 0, kNoGroup}, {1, 1, kNoGroup}, {0, kNoGroup, 0}, {0, kNoGroup, 1}};
    const std::vector<LevelGroup> groups{{{0, 0, 0}, 8, leftError, 0}, {{10, 0, 0}, 8, 0.1, 0}};
    const Box left{{-1, -4, -4}, {1, 4, 4}}, right{{9, -4, -4}, {11, 4, 4}};
    const std::vector<Box> boxes{left, right, left, right};
    const std::vector<uint64_t> bytes{1, 1, 11, 11};
    const std::vector<uint32_t> cells(4, 1);
    graph = LevelGraph({levels, groups, bytes, cells, boxes});
  }
  std::vector<uint32_t> boughtBy(const std::vector<StreamEye>& eyes, CutLimits limits) const {
    AssetDemand demand{&graph, eyes, GroupSet(graph.groupCount())};
    Selection selection;
    selection.select({&demand, 1}, limits);
    const auto members = demand.wanted.members();
    return {members.begin(), members.end()};
  }
};

TEST(Selection, BuysWhatIsSeenFirstAndAllThatIsWantedWhereTheBudgetReaches) {
  const TwoWalls walls(0.2);
  const SightPlane forwards{{1, 0, 0}, 0}, backwards{{-1, 0, 0}, 0};
  const auto boughtBy = [&](const std::vector<StreamEye>& eyes, uint64_t bytes) {
    return walls.boughtBy(eyes, {.bytes = bytes});
  };
  const StreamEye all{{5, 0, 0}, 0, 0.01, 1e-6, 1};
  StreamEye right1 = all, left1 = all, none = all;
  right1.sight[0] = forwards;
  left1.sight[0] = backwards;
  none.sight[0] = {{0, 1, 0}, -5};
  using Groups = std::vector<uint32_t>;
  EXPECT_EQ(boughtBy({all}, 22), (Groups{0, 1}));  // by error
  EXPECT_EQ(boughtBy({right1}, 22), (Groups{1, 0}));
  EXPECT_EQ(boughtBy({right1}, 11), Groups{1});
  EXPECT_EQ(boughtBy({left1}, 11), Groups{0});
  EXPECT_EQ(boughtBy({none}, 22), (Groups{0, 1}));
  EXPECT_EQ(boughtBy({right1, left1}, 22), (Groups{0, 1}));
  StreamEye beside = right1;
  beside.position.x = 1.01;  // so near to the wall behind it that it comes first all the same
  EXPECT_EQ(boughtBy({beside}, 22), (Groups{0, 1}));
}

TEST(Selection, SeesBoundsThatReachBeforeAllPlanes) {
  StreamEye eye{.position = {1, 0, 0}};
  const GroupBounds box{{2, -1, -1}, {3, 1, 1}};
  EXPECT_TRUE(sees(eye, box));
  eye.sight[0] = {{1, 0, 0}, -2};  // x >= 3
  EXPECT_TRUE(sees(eye, box));
  eye.sight[1] = {{0, -1, 0}, -0.99};  // y <= -0.99
  EXPECT_TRUE(sees(eye, box));
  eye.sight[1].offset = -1.01;
  EXPECT_FALSE(sees(eye, box));
  EXPECT_TRUE(sees(eye, {{-9, -2, -9}, {9, 2, 9}}));
}

TEST(Selection, LeavesAGroupWhoseBallHoldsTheEyeButWhoseBoxDoesNotAtASmallDetail) {
  const TwoWalls walls(0.1);
  const auto wantedAt = [&](const glm::dvec3& position, double detail) {
    return walls.boughtBy({{position, 0, 0.01, 1e-6, detail}}, {});
  };
  EXPECT_EQ(wantedAt({5, 0, 0}, 1).size(), 2u);  // a pixel of 0.04 at both walls
  EXPECT_TRUE(wantedAt({5, 0, 0}, 0.39).empty());
  EXPECT_EQ(wantedAt({0.5, 0, 0}, 0.39), std::vector{0u});
}

TEST(Selection, IsACutEvenWhereKeysOfFinerGroupsAreGreater) {
  LevelDag dag = makeLevelDag(1, {20, 2, 4});
  for (LevelGroup& group : dag.groups) group.error = 2 - 0.1 * group.level;  // as no reader lets through
  const LevelGraph graph = dag.graph();
  AssetDemand demand{&graph, {{{0, 0, 0}, 0, 0, 1, 1}}, GroupSet(graph.groupCount())};
  Selection selection;
  selection.select({&demand, 1}, {});
  EXPECT_EQ(selection.bought().size(), graph.groupCount());
  for (size_t i = 0; i < selection.bought().size(); ++i) {
    for (const uint32_t coarser : graph.coarserThan(selection.bought()[i].group)) {
      const auto members = demand.wanted.members();
      EXPECT_LT(std::ranges::find(members, coarser) - members.begin(), static_cast<std::ptrdiff_t>(i));
    }
  }
}

}  // namespace
}  // namespace froth::test
