// What a ChunkStreamer does, case by case. flight_test.cpp has what holds in all of them.
#include "runtime/stream/chunk_streamer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/format/allocation_counter.h"
#include "tests/stream/level_dag.h"
#include "tests/stream/simulated_owner.h"

namespace froth::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr uint32_t kReads = 100;  // room for all
constexpr StreamOptions kOptions{.keepFrames = 4, .retryFrames = 3};

// Chunk 0 is the floor, made by group 1 of chunks 1 and 2, which are made by group 0 of chunks 3 to 6. 100 bytes each,
// if nothing else is said of the finest.
//
//        0            floor
//       1 2           in group 1
//     3 4 5 6         in group 0
LevelGraph makeLadder(uint64_t finestBytes = 100) {
  const std::vector<ChunkLevel> levels{{2, 1, kNoGroup}, {1, 0, 1},        {1, 0, 1},       {0, kNoGroup, 0},
                                       {0, kNoGroup, 0}, {0, kNoGroup, 0}, {0, kNoGroup, 0}};
  const std::vector<LevelGroup> groups{{{0, 0, 0}, 1, 0.1, 0}, {{0, 0, 0}, 1, 1, 1}};
  std::vector<uint64_t> bytes(7, 100);
  for (size_t chunk = 3; chunk < 7; ++chunk) bytes[chunk] = finestBytes;
  const std::vector<uint32_t> cells(7, 10);
  return LevelGraph({levels, groups, bytes, cells, std::vector<Box>(levels.size())});
}

// Two of them in one asset, of chunks 0 to 6 and 7 to 13, which lie 100 apart.
LevelGraph makeTwoLadders() {
  std::vector<ChunkLevel> levels;
  for (const uint32_t first : {0u, 2u}) {
    levels.insert(levels.end(), {{2, first + 1, kNoGroup}, {1, first, first + 1}, {1, first, first + 1}});
    levels.insert(levels.end(), 4, {0, kNoGroup, first});
  }
  const std::vector<LevelGroup> groups{
      {{0, 0, 0}, 1, 0.1, 0}, {{0, 0, 0}, 1, 1, 1}, {{100, 0, 0}, 1, 0.1, 0}, {{100, 0, 0}, 1, 1, 1}};
  const std::vector<uint64_t> bytes(14, 100);
  const std::vector<uint32_t> cells(14, 10);
  return LevelGraph({levels, groups, bytes, cells, std::vector<Box>(levels.size())});
}

// Eyes with one size of pixel everywhere.
constexpr StreamEye kFar{.pixelSize = 2}, kMiddle{.pixelSize = 0.5}, kNear{.pixelSize = 0.05};

class Ladder : public testing::Test {
 protected:
  Ladder() : streamer(kOptions) {
    EXPECT_TRUE(streamer.setBudget(10'000));
    asset = streamer.addAsset(makeLadder());
    EXPECT_TRUE(streamer.placeAsset(asset));
  }

  void look(const StreamEye& eye) { streamer.setEyes(asset, {&eye, 1}); }
  // Chunks to read, which stay on their way.
  std::vector<uint32_t> update() {
    const StreamActions& actions = streamer.update(kReads);
    evictions.clear();
    for (const ChunkId id : actions.evictions) evictions.push_back(id.chunk);
    std::vector<uint32_t> reads;
    for (const ChunkId id : actions.reads) reads.push_back(id.chunk);
    return reads;
  }
  void bring(std::vector<uint32_t> chunks) {
    for (const uint32_t chunk : chunks) streamer.advance({asset, chunk}, ChunkState::kResident);
  }
  // Brings what is asked for until nothing is.
  void settle() {
    for (std::vector<uint32_t> reads = update(); !reads.empty(); reads = update()) bring(reads);
    EXPECT_TRUE(streamer.isSettled());
  }
  std::vector<uint32_t> drawn() const {
    std::vector<uint32_t> chunks;
    for (uint32_t chunk = 0; chunk < 7; ++chunk) {
      if (streamer.isDrawn({asset, chunk})) chunks.push_back(chunk);
    }
    return chunks;
  }
  ChunkState state(uint32_t chunk) const { return streamer.state({asset, chunk}); }

  ChunkStreamer streamer;
  uint32_t asset = 0;
  std::vector<uint32_t> evictions;
};

TEST_F(Ladder, SharpensALevelAtATimeAndShowsAGroupWhenAllOfItIsThere) {
  look(kNear);
  EXPECT_THAT(update(), ElementsAre(0, 1, 2, 3, 4, 5, 6));
  bring({1, 2});
  update();
  EXPECT_THAT(drawn(), IsEmpty());  // not before the floor
  bring({0});
  update();
  EXPECT_THAT(drawn(), ElementsAre(1, 2));
  bring({3, 4, 5});
  update();
  EXPECT_THAT(drawn(), ElementsAre(1, 2));
  bring({6});
  update();
  EXPECT_THAT(drawn(), ElementsAre(3, 4, 5, 6));
  EXPECT_TRUE(streamer.isSettled());
}

TEST_F(Ladder, SkipsALevelWhoseFinerOneIsThere) {
  look(kNear);
  update();
  bring({0, 3, 4, 5, 6});
  update();
  EXPECT_THAT(drawn(), ElementsAre(3, 4, 5, 6));
}

TEST_F(Ladder, BecomesCoarserOnlyWhenTheCoarseFormIsThere) {
  look(kNear);
  update();
  bring({0, 3, 4, 5, 6});  // 1 and 2 are still on their way
  settle();
  look(kMiddle);
  update();
  bring({1});
  update();
  EXPECT_THAT(drawn(), ElementsAre(3, 4, 5, 6));
  bring({2});
  update();
  EXPECT_THAT(drawn(), ElementsAre(1, 2));
  look(kFar);
  update();
  EXPECT_THAT(drawn(), ElementsAre(0));
}

TEST_F(Ladder, KeepsWhatIsNotWantedUntilItsRoomIsNeeded) {
  look(kNear);
  settle();
  look(kFar);
  for (int frame = 0; frame < 20; ++frame) {
    update();
    EXPECT_THAT(evictions, IsEmpty());
  }
  EXPECT_TRUE(streamer.setBudget(500));  // of 700 that are used
  update();
  EXPECT_EQ(streamer.statistics().excessBytes, 200);
  EXPECT_THAT(evictions, ElementsAre(1, 2));  // drawn last before the others
  EXPECT_EQ(state(1), ChunkState::kEvicting);
  update();
  EXPECT_THAT(evictions, IsEmpty());
  streamer.completeEviction({asset, 1});
  EXPECT_EQ(state(1), ChunkState::kAbsent);
  EXPECT_EQ(streamer.statistics().usedBytes, 600);
}

TEST_F(Ladder, DoesNotEvictWhatWasDrawnAMomentAgo) {
  look(kNear);
  settle();
  for (int frame = 0; frame < 10; ++frame) update();
  look(kFar);
  EXPECT_TRUE(streamer.setBudget(100));
  update();  // hides 3 to 6
  EXPECT_THAT(evictions, ElementsAre(1, 2));
  for (uint32_t frame = 1; frame < kOptions.keepFrames; ++frame) {
    update();
    EXPECT_THAT(evictions, IsEmpty());
  }
  update();
  EXPECT_THAT(evictions, ElementsAre(3, 4, 5, 6));
}

TEST_F(Ladder, FallsToTheFloorWhereFinerChunksHoldTheRoomOfCoarserOnes) {
  look(kNear);
  update();
  bring({0, 3, 4, 5, 6});
  streamer.fail({asset, 1}, true);
  streamer.fail({asset, 2}, true);
  settle();  // 3 to 6 are drawn, 1 and 2 are absent
  look(kMiddle);
  EXPECT_TRUE(streamer.setBudget(500));  // of which 500 are used
  for (uint32_t frame = 0; frame < kOptions.keepFrames + 3; ++frame) {
    for (const uint32_t chunk : update()) ADD_FAILURE() << chunk << " is read above the budget";
    for (const uint32_t chunk : evictions) EXPECT_GE(chunk, 3);
    if (!evictions.empty()) break;
  }
  EXPECT_THAT(drawn(), ElementsAre(0));
  EXPECT_THAT(evictions, ElementsAre(3, 4));  // the room of 1 and 2
  streamer.completeEviction({asset, 3});
  EXPECT_THAT(update(), ElementsAre(1));
  streamer.completeEviction({asset, 4});
  EXPECT_THAT(update(), ElementsAre(2));
  bring({1, 2});
  update();
  EXPECT_THAT(drawn(), ElementsAre(1, 2));
  EXPECT_TRUE(streamer.isSettled());
}

TEST_F(Ladder, TriesAFailedChunkAgainLaterAndLaterAndThenStaysCoarser) {
  look(kNear);
  update();
  bring({0, 1, 2, 4, 5, 6});
  std::vector<uint32_t> waits;
  for (uint32_t attempt = 0; attempt < ChunkStreamer::kMostRetries; ++attempt) {
    streamer.fail({asset, 3}, true);
    EXPECT_EQ(state(3), ChunkState::kRetry);
    uint32_t frames = 1;
    for (; frames < 1000 && update().empty(); ++frames) EXPECT_FALSE(streamer.isSettled());
    waits.push_back(frames);
  }
  EXPECT_THAT(waits, ElementsAre(3, 12, 48));
  EXPECT_GE(streamer.statistics().oldestRequest, 60);
  streamer.fail({asset, 3}, true);
  EXPECT_EQ(state(3), ChunkState::kFailed);
  EXPECT_THAT(update(), IsEmpty());
  EXPECT_THAT(drawn(), ElementsAre(1, 2));
  EXPECT_TRUE(streamer.isSettled());
  EXPECT_EQ(streamer.statistics().retries, 3);
  EXPECT_EQ(streamer.statistics().failures, 1);
  EXPECT_EQ(streamer.statistics().states[static_cast<size_t>(ChunkState::kFailed)].chunks, 1);
}

TEST_F(Ladder, StepsOverAFailedChunkBetweenFloorAndFinest) {
  look(kNear);
  update();
  streamer.fail({asset, 1}, false);
  bring({0, 2, 3, 4, 5});
  update();
  EXPECT_THAT(drawn(), ElementsAre(0));
  EXPECT_EQ(streamer.statistics().floorHits, 1);
  bring({6});
  update();
  EXPECT_THAT(drawn(), ElementsAre(3, 4, 5, 6));
  EXPECT_EQ(streamer.statistics().floorHits, 0);
  look(kMiddle);  // would draw it
  update();
  EXPECT_THAT(drawn(), ElementsAre(0));
  EXPECT_TRUE(streamer.isSettled());
}

TEST_F(Ladder, BeginsAsManyReadsAsThereIsRoomForMostWantedFirst) {
  look(kNear);
  EXPECT_THAT(streamer.update(2).reads, ElementsAre(ChunkId{asset, 0}, ChunkId{asset, 1}));
  EXPECT_THAT(streamer.update(0).reads, IsEmpty());
  EXPECT_THAT(streamer.update(1).reads, ElementsAre(ChunkId{asset, 2}));
}

TEST_F(Ladder, WantsNoMoreCellsThanItMay) {
  look(kNear);
  streamer.setCellBudget(39);  // the finest level has 40
  settle();
  EXPECT_THAT(drawn(), ElementsAre(1, 2));
  streamer.setCellBudget(5);  // less than the floor
  settle();
  EXPECT_THAT(drawn(), ElementsAre(0));
}

TEST_F(Ladder, LetsTheFloorGoWhenNoInstanceIsLeft) {
  look(kFar);
  settle();
  streamer.unplaceAsset(asset);
  EXPECT_THAT(streamer.update(kReads).hidden, ElementsAre(ChunkId{asset, 0}));
  EXPECT_EQ(state(0), ChunkState::kResident);
  EXPECT_TRUE(streamer.setBudget(0));
  for (uint32_t frame = 0; frame < kOptions.keepFrames; ++frame) update();
  EXPECT_THAT(evictions, ElementsAre(0));
}

TEST_F(Ladder, RefusesABudgetBelowTheFloorsWithNumbers) {
  const Status lower = streamer.setBudget(99);
  ASSERT_FALSE(lower);
  EXPECT_THAT(lower.error().message, HasSubstr("99 bytes are less than the 100 of the floors"));
  EXPECT_TRUE(streamer.setBudget(150));
  const uint32_t second = streamer.addAsset(makeLadder());
  const Status placed = streamer.placeAsset(second);
  ASSERT_FALSE(placed);
  EXPECT_THAT(placed.error().message, HasSubstr("allow 200"));
  EXPECT_TRUE(streamer.setBudget(200));
  EXPECT_TRUE(streamer.placeAsset(second));
}

TEST_F(Ladder, EvictsAllOfARemovedAssetAndGivesItsNumberAnew) {
  look(kNear);
  update();
  bring({0, 1});  // the others are on their way
  streamer.removeAsset(asset);
  update();
  EXPECT_EQ(evictions.size(), 7);
  for (const uint32_t chunk : evictions) streamer.completeEviction({asset, chunk});
  EXPECT_TRUE(streamer.hasAsset(asset));
  update();
  EXPECT_FALSE(streamer.hasAsset(asset));
  EXPECT_EQ(streamer.addAsset(makeLadder()), asset);
}

// Not even the coarse chunks of the groups that were refined.
TEST_F(Ladder, ShowsNothingOfARemovedAsset) {
  look(kNear);
  for (int i = 0; i < 5; ++i) bring(update());
  EXPECT_FALSE(streamer.refined(asset).members().empty());
  streamer.removeAsset(asset);
  const StreamActions& actions = streamer.update(kReads);
  EXPECT_TRUE(actions.shown.empty());
  EXPECT_FALSE(actions.hidden.empty());
}

// The second chunk of a floor is there; the first has failed once and then finds no room. Finer chunks of the ladder
// hold it, and the coarser ones that are wanted instead have failed too, a frame later.
TEST(ChunkStreamer, DoesNotGiveUpAFloorThatIsHalfThere) {
  const std::vector<uint64_t> bytes{100, 100};
  const std::vector<uint32_t> cells{1, 1};
  ChunkStreamer streamer(kOptions);
  EXPECT_TRUE(streamer.setBudget(10'000));
  const uint32_t flat = streamer.addAsset(LevelGraph({{}, {}, bytes, cells, {}}));
  EXPECT_TRUE(streamer.placeAsset(flat));
  streamer.update(kReads);
  streamer.fail({flat, 0}, true);
  streamer.advance({flat, 1}, ChunkState::kResident);

  const uint32_t ladder = streamer.addAsset(makeLadder(150));
  EXPECT_TRUE(streamer.placeAsset(ladder));
  streamer.setEyes(ladder, {&kNear, 1});
  streamer.update(kReads);
  for (const uint32_t chunk : {0, 3, 4, 5, 6}) streamer.advance({ladder, chunk}, ChunkState::kResident);
  for (const uint32_t chunk : {1, 2}) streamer.fail({ladder, chunk}, true);
  streamer.update(kReads);
  EXPECT_TRUE(streamer.isSettled(ladder));

  streamer.setEyes(ladder, {&kMiddle, 1});
  EXPECT_TRUE(streamer.setBudget(800));  // which are used
  EXPECT_THAT(streamer.update(kReads).evictions, IsEmpty());
  EXPECT_THAT(streamer.update(kReads).shown, ElementsAre(ChunkId{ladder, 0}));  // instead of the finest chunks
}

TEST(ChunkStreamer, GivesUpOnlyWhatIsNotWanted) {
  ChunkStreamer streamer(kOptions);
  EXPECT_TRUE(streamer.setBudget(10'000));
  const uint32_t asset = streamer.addAsset(makeTwoLadders());
  EXPECT_TRUE(streamer.placeAsset(asset));
  StreamEye eye{{0, 0, 0}, 200, 0.005, 0.05, 1};  // anywhere near: wants all
  streamer.setEyes(asset, {&eye, 1});
  streamer.update(kReads);
  for (const uint32_t chunk : {0, 3, 4, 5, 6, 7, 10, 11, 12, 13}) {
    streamer.advance({asset, chunk}, ChunkState::kResident);
  }
  for (const uint32_t chunk : {1, 2, 8, 9}) streamer.fail({asset, chunk}, true);
  streamer.update(kReads);
  EXPECT_TRUE(streamer.isSettled());
  eye.radius = 0;  // wants the middle of the second ladder
  streamer.setEyes(asset, {&eye, 1});
  EXPECT_TRUE(streamer.setBudget(1000));  // which are used
  for (uint32_t frame = 0; frame < kOptions.retryFrames + 2; ++frame) streamer.update(kReads);
  EXPECT_TRUE(streamer.isDrawn({asset, 7}));
  for (const uint32_t chunk : {3, 4, 5, 6}) EXPECT_TRUE(streamer.isDrawn({asset, chunk}));
}

TEST(ChunkStreamer, DrawsAnAssetWithoutLevelsWhenAllOfItIsThere) {
  const std::vector<uint64_t> bytes{10, 20};
  const std::vector<uint32_t> cells{1, 2};
  ChunkStreamer streamer;
  EXPECT_TRUE(streamer.setBudget(30));
  const uint32_t asset = streamer.addAsset(LevelGraph({{}, {}, bytes, cells, {}}));
  EXPECT_TRUE(streamer.placeAsset(asset));
  EXPECT_EQ(streamer.update(kReads).reads.size(), 2);
  streamer.advance({asset, 0}, ChunkState::kResident);
  EXPECT_THAT(streamer.update(kReads).shown, IsEmpty());
  streamer.advance({asset, 1}, ChunkState::kResident);
  EXPECT_EQ(streamer.update(kReads).shown.size(), 2);
  EXPECT_TRUE(streamer.isSettled());
}

TEST(ChunkStreamer, AllocatesNothingInAnUpdate) {
  const LevelDag dag = makeLevelDag(1, {200, 3, 5});
  ChunkStreamer streamer(kOptions);
  EXPECT_TRUE(streamer.setBudget(6'000));
  const uint32_t asset = streamer.addAsset(dag.graph());
  EXPECT_TRUE(streamer.placeAsset(asset));
  std::vector<ChunkId> toDo;
  toDo.reserve(10'000);
  size_t actions = 0, allocated = 0;
  for (uint32_t frame = 0; frame < 2000; ++frame) {
    const StreamEye eye = makeEye(frame / 50, dag);
    streamer.setEyes(asset, {&eye, 1});
    forgetAllocations();
    const StreamActions& answer = streamer.update(8);
    for (const ChunkId id : answer.reads) toDo.push_back(id);
    for (const ChunkId id : answer.reads) streamer.advance(id, ChunkState::kResident);
    for (const ChunkId id : answer.evictions) streamer.completeEviction(id);
    allocated += allocatedBytes();
    actions += toDo.size();
    toDo.clear();
  }
  EXPECT_GT(actions, 500);
  EXPECT_EQ(allocated, 0);
}

}  // namespace
}  // namespace froth::test
