// The sample with levels of detail in a context that streams it, through a reader that can fail.
#pragma once

#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "froth/froth_reader.h"
#include "froth/froth_stream.h"
#include "host/make_struct.h"
#include "runtime/context/context.h"
#include "tests/levels/level_cuts.h"
#include "tests/render/render_harness.h"

namespace froth::test {

inline constexpr VkExtent2D kStreamedExtent = {64, 48};
inline constexpr int kMostFrames = 800;  // until all has come; a chunk is tried again after 30, 120 and 480

inline View lookFrom(double distance) {
  return lookAt({0.1, 0.2, -distance}, {0, 0, 0}, kStreamedExtent.width, kStreamedExtent.height, 0.9);
}
// Distances:
inline constexpr double kNear = 0.5, kBetween = 1.748, kFar = 1e6;  // level 0; the floor but for one group; the floor

// The sample's bytes through a reader that answers at once, and fails where it is told to.
class Reader {
 public:
  explicit Reader(const AssetContents& contents = levelSample()) : bytes_(*encodeAsset(contents)) {}

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
  explicit Streamed(Reader& reader, uint64_t budget = 0, uint32_t fadeFrames = 0) {
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
    view.maxExtent = kStreamedExtent;
    view.fadeFrames = fadeFrames;
    check(frothCreateView(context_, &view, &view_), "frothCreateView");
    image_ = *sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kStreamedExtent);
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
      isWhole = drawn == FROTH_OK;
      return {};
    });
    EXPECT_TRUE(submitted) << submitted.error().message;
    EXPECT_TRUE(!isReady() || !drawn().empty() || !context_->findAsset(asset_)->hasLevels());
  }
  // Until what is wanted from there is drawn.
  void settle(double distance) {
    frame(distance);
    frame(distance);
    for (int i = 0; i < kMostFrames && !isSettled(); ++i) frame(distance, i % 2 == 1);
    EXPECT_TRUE(isSettled()) << (messages.empty() ? "" : messages.front());
  }
  bool isSettled() const { return isReady() && status().isSettled != 0; }
  FrothStreamStatus status() const {
    auto status = makeStruct<FrothStreamStatus>();
    check(frothGetStreamStatus(context_, &status), "frothGetStreamStatus");
    return status;
  }
  FrothAssetStatus assetStatus() const {
    auto status = makeStruct<FrothAssetStatus>();
    check(frothGetAssetStatus(context_, asset_, &status), "frothGetAssetStatus");
    return status;
  }
  bool isReady() const { return assetStatus().state == FROTH_ASSET_READY; }
  std::vector<FrothChunk> chunks() const {
    uint32_t count = 0;
    check(frothGetChunks(context_, asset_, 0, nullptr, &count), "frothGetChunks");
    std::vector<FrothChunk> chunks(count);
    check(frothGetChunks(context_, asset_, count, chunks.data(), &count), "frothGetChunks");
    return chunks;
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
  FrothAsset asset() const { return asset_; }

  std::vector<std::string> messages;
  uint64_t mostBytes = 0;  // of device memory at the end of an update
  bool isWhole = false;    // the newest frame had all instances, with room for all cells

 private:
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  FrothInstance instance_{};
  FrothView view_{};
  HostImage image_;
};

}  // namespace froth::test
