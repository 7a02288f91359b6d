// What views see decides which chunks come, within the budget, whatever was before and whatever readers do.
#include <cstring>
#include <map>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "froth/froth_reader.h"
#include "froth/froth_stream.h"
#include "host/make_struct.h"
#include "runtime/context/context.h"
#include "tests/levels/level_cuts.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent = {64, 48};
constexpr int kMostFrames = 800;  // until all has come; a chunk is tried again after 30, 120 and 480

View lookFrom(double distance) { return lookAt({0.1, 0.2, -distance}, {0, 0, 0}, kExtent.width, kExtent.height, 0.9); }
const double kNear = 0.5, kBetween = 2.7, kFar = 1e6;  // level 0; the floor but for one group; the floor

// The sample's bytes through a reader that answers at once, and fails where it is told to.
class Reader {
 public:
  Reader() : bytes_(*encodeAsset(levelSample())) {}

  FrothReader describe() {
    return {sizeof(FrothReader),
            this,
            "sample",
            bytes_.size(),
            [](void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
              static_cast<Reader*>(user)->read(request, offset, size, destination);
            },
            nullptr};
  }
  // Of each range that begins behind the head, the first `count` reads.
  void failFirst(int count) { failures_ = count; }
  // All reads of one range that begins behind the head: the first that is asked for from now on.
  void failOneForGood() { isNextBad_ = true; }
  void startAfter(uint64_t head) { head_ = head; }
  FrothContext* context = nullptr;

 private:
  void read(uint64_t request, uint64_t offset, uint64_t size, void* destination) {
    std::memcpy(destination, bytes_.data() + offset, size);
    if (offset >= head_ && std::exchange(isNextBad_, false)) bad_ = offset;
    const bool fails = offset >= head_ && (bad_ == offset || ++reads_[offset] <= failures_);
    check(frothCompleteRead(context, request, fails ? FROTH_ERROR_FILE : FROTH_OK), "frothCompleteRead");
  }

  std::vector<uint8_t> bytes_;
  std::map<uint64_t, int> reads_;
  uint64_t head_ = UINT64_MAX, bad_ = UINT64_MAX;
  int failures_ = 0;
  bool isNextBad_ = false;
};

class Streamed {
 public:
  explicit Streamed(Reader& reader, uint64_t budget = 0) {
    FrothContextInfo info = checkedContextInfo(0);
    info.deviceBudget = budget;
    info.messageUser = this;
    info.onMessage = [](void* user, FrothSeverity, FrothResult, const char* object, const char* text) {
      static_cast<Streamed*>(user)->messages.push_back(std::string(object) + ": " + text);
    };
    check(frothCreateContext(&info, &context_), "frothCreateContext");
    reader.context = context_;
    const FrothReader described = reader.describe();
    auto asset = makeStruct<FrothAssetInfo>();
    asset.reader = &described;
    check(frothOpenAsset(context_, &asset, &asset_), "frothOpenAsset");
    auto instance = makeStruct<FrothInstanceInfo>();
    instance.asset = asset_;
    check(frothCreateInstance(context_, &instance, &instance_), "frothCreateInstance");
    auto view = makeStruct<FrothViewInfo>();
    view.maxExtent = kExtent;
    check(frothCreateView(context_, &view, &view_), "frothCreateView");
    image_ = *sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
  }
  ~Streamed() {
    check(frothDestroyContext(context_, UINT64_MAX), "frothDestroyContext");
    sharedHost().destroyImage(image_);
  }

  // READY assets have their floor, or what is finer.
  void frame(double distance, bool isWalk = false) {
    FrothRenderInfo info = infoOf(lookFrom(distance));
    info.colour = sharedHost().describe(image_);
    const Status submitted = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t serial) -> Status {
      const FrothFrame begun{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
      auto status = makeStruct<FrothFrameStatus>();
      check(frothUpdate(context_, &begun, &status), "frothUpdate");
      if (status.deviceBytes > mostBytes) mostBytes = status.deviceBytes;
      check(frothRecordUpload(context_, commandBuffer), "frothRecordUpload");
      const FrothResult drawn = (isWalk ? frothRecordWalk : frothRecordRaster)(context_, view_, commandBuffer, &info);
      EXPECT_GE(drawn, FROTH_OK);
      return {};
    });
    EXPECT_TRUE(submitted) << submitted.error().message;
    EXPECT_TRUE(!isReady() || !drawn().empty());
  }
  // Until what is wanted from there is drawn.
  void settle(double distance) {
    frame(distance);
    frame(distance);
    for (int i = 0; i < kMostFrames && !isSettled(); ++i) frame(distance, i % 2 == 1);
    EXPECT_TRUE(isSettled()) << (messages.empty() ? "" : messages.front());
  }
  bool isSettled() const { return isReady() && status().isSettled != 0; }
  bool isReady() const {
    auto status = makeStruct<FrothAssetStatus>();
    check(frothGetAssetStatus(context_, asset_, &status), "frothGetAssetStatus");
    return status.state == FROTH_ASSET_READY;
  }
  FrothStreamStatus status() const {
    auto status = makeStruct<FrothStreamStatus>();
    check(frothGetStreamStatus(context_, &status), "frothGetStreamStatus");
    return status;
  }
  std::vector<uint32_t> drawn() const {
    const std::span<const uint32_t> chunks = context_->findAsset(asset_)->drawnChunks();
    return {chunks.begin(), chunks.end()};
  }
  void close() {
    check(frothDestroyInstance(context_, instance_), "frothDestroyInstance");
    check(frothCloseAsset(context_, asset_), "frothCloseAsset");
  }
  FrothContext* context() const { return context_; }

  std::vector<std::string> messages;
  uint64_t mostBytes = 0;  // of device memory at the end of an update

 private:
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  FrothInstance instance_{};
  FrothView view_{};
  HostImage image_;
};

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
