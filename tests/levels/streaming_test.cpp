// What views see decides which chunks come, within the budget, whatever was before and whatever readers do.
#include <gtest/gtest.h>

#include "tests/levels/streamed.h"

namespace froth::test {
namespace {

TEST(Streaming, BringsWhatViewsSee) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), floorCut());
  streamed.settle(kNear);
  EXPECT_EQ(streamed.drawn(), finestCut());
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), floorCut());
  EXPECT_TRUE(streamed.messages.empty());
}

TEST(Streaming, SettlesTheSameWhateverWasBefore) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kBetween);
  const std::vector<uint32_t> between = streamed.drawn();
  EXPECT_NE(between, floorCut());
  EXPECT_NE(between, finestCut());
  for (const double before : {kNear, kFar}) {
    streamed.settle(before);
    streamed.settle(kBetween);
    EXPECT_EQ(streamed.drawn(), between);
  }
  for (int i = 0; i < 5; ++i) streamed.frame(kNear);  // on the way
  streamed.settle(kBetween);
  EXPECT_EQ(streamed.drawn(), between);
}

TEST(Streaming, DetailAndPointsCountAsViewsDo) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kFar);
  FrothStreamPoint point{{0.1, 0.2, -kNear}, 0, 0.03f, 0};
  auto info = makeStruct<FrothStreamInfo>();
  info.points = &point;
  info.pointCount = 1;
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), finestCut());
  info.pointCount = 0;
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), floorCut());
  info.detail = 1e9f;
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), finestCut());
  info.mostCells = 1;
  check(frothSetStreaming(streamed.context(), &info), "frothSetStreaming");
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), floorCut());
}

TEST(Streaming, StaysWithinTheBudget) {
  Reader reader;
  uint64_t whole = 0;
  {
    Streamed unlimited(reader);
    unlimited.settle(kNear);
    whole = unlimited.mostBytes;
  }
  size_t finest = 0, coarser = 0;
  for (uint64_t sixteenths = 10; sixteenths <= 32; sixteenths += 3) {
    Streamed streamed(reader, whole * sixteenths / 16);
    for (int i = 0; i < 40; ++i) streamed.frame(i % 16 < 8 ? kNear : kBetween, i % 2 == 1);
    streamed.settle(kNear);
    EXPECT_LE(streamed.mostBytes, whole * sixteenths / 16);
    (streamed.drawn() == finestCut() ? finest : coarser) += 1;
  }
  EXPECT_GT(finest, 0u);
  EXPECT_GT(coarser, 0u);
}

TEST(Streaming, TriesAgainWhatCouldNotBeRead) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kFar);
  reader.startAfter(1);
  reader.failFirst(1);
  streamed.settle(kNear);
  EXPECT_EQ(streamed.drawn(), finestCut());
  EXPECT_GT(streamed.status().retries, 0u);
  EXPECT_TRUE(streamed.messages.empty());
}

TEST(Streaming, GoesOnWithoutAChunkThatFailsForGood) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kFar);
  reader.startAfter(1);
  reader.failOneForGood();
  streamed.frame(kBetween);
  for (int i = 0; i < kMostFrames && streamed.status().failures == 0; ++i) streamed.frame(kBetween);
  streamed.settle(kBetween);
  EXPECT_EQ(streamed.status().failedChunks, 1u);
  EXPECT_EQ(std::ranges::count(streamed.chunks(), FROTH_CHUNK_FAILED, &FrothChunk::state), 1);
  EXPECT_EQ(streamed.drawn(), floorCut());
  ASSERT_EQ(streamed.messages.size(), 1u);
  EXPECT_NE(streamed.messages.front().find("sample: other levels stand for chunk "), std::string::npos)
      << streamed.messages.front();
}

TEST(Streaming, EndsWithItsAsset) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kFar);
  for (int i = 0; i < 3; ++i) streamed.frame(kNear);
  streamed.close();
  const FrothFrame begun{sizeof(FrothFrame), UINT32_MAX, UINT32_MAX - 1, 0, 0, 0, 0};
  check(frothUpdate(streamed.context(), &begun, nullptr), "frothUpdate");
  EXPECT_EQ(streamed.status().drawnChunks, 0u);
}

TEST(Streaming, RefusesNumbersThatSayNothing) {
  Reader reader;
  Streamed streamed(reader);
  FrothStreamPoint point{{0, 0, 0}, 0, 0, 0};
  auto info = makeStruct<FrothStreamInfo>();
  info.detail = -1;
  EXPECT_EQ(frothSetStreaming(streamed.context(), &info), FROTH_ERROR_ARGUMENT);
  info.detail = 0;
  info.pointCount = 1;
  EXPECT_EQ(frothSetStreaming(streamed.context(), &info), FROTH_ERROR_ARGUMENT);
  info.points = &point;
  EXPECT_EQ(frothSetStreaming(streamed.context(), &info), FROTH_ERROR_ARGUMENT);
  ASSERT_EQ(streamed.messages.size(), 3u);
  EXPECT_NE(streamed.messages[0].find("detail: -1"), std::string::npos);
  EXPECT_NE(streamed.messages[1].find("points: null"), std::string::npos);
  EXPECT_NE(streamed.messages[2].find("points[0].pixelAngle"), std::string::npos);
}

}  // namespace
}  // namespace froth::test
