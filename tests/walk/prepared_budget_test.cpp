// Prepared cells (FrothAssetInfo::prepareRays) and the budget: they go before anything else does, come once all else
// has what it wants, and rays go on meanwhile.
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "froth/froth_stream.h"
#include "host/make_struct.h"
#include "tests/format/level_sample.h"
#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/walk/walk_stage.h"

namespace froth::test {
namespace {

constexpr uint32_t kFramesInFlight = 3;
constexpr VkExtent2D kExtent = {32, 32};
constexpr int kMostFrames = 60;

struct Shot {
  FrothFrameStatus frame;
  FrothAssetStatus asset;
  FrothViewStatus view;
  std::vector<FrothGpuHit> hits;
};

bool areSame(const std::vector<FrothGpuHit>& a, const std::vector<FrothGpuHit>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(FrothGpuHit)) == 0;
}

const AssetContents& chunkedFoam() {
  static const AssetContents foam = bakeScene(makeRandomFoam(300, 2, 1, 3), "exact", 64);
  return foam;
}

// One asset, seen by a view and met by rays, in a context of its own.
class PreparedBudget : public testing::Test {
 protected:
  void TearDown() override {
    EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
    device_.destroyBuffer(rays_);
    EXPECT_EQ(sharedHost().validationMessages().size(), reported_);
  }

  void open(const AssetContents& contents, FrothRayPreparation prepared, uint64_t budget = 0) {
    reported_ = sharedHost().validationMessages().size();
    FrothContextInfo info = checkedContextInfo(0);
    info.walkShaders = 1;
    info.framesInFlight = kFramesInFlight;
    info.deviceBudget = budget;
    info.messageUser = this;
    info.onMessage = [](void* user, FrothSeverity severity, FrothResult, const char*, const char* text) {
      EXPECT_EQ(severity, FROTH_SEVERITY_WARNING) << text;
      static_cast<PreparedBudget*>(user)->warnings_.emplace_back(text);
    };
    check(frothCreateContext(&info, &context_), "frothCreateContext");
    device_ = *Device::create(info.getInstanceProcAddr, info.instance, info.physicalDevice, info.device);
    bytes_ = *encodeAsset(contents);
    auto asset = makeStruct<FrothAssetInfo>();
    asset.data = bytes_.data();
    asset.dataSize = bytes_.size();
    asset.bytesStay = 1;
    asset.layersMayGo = 1;
    asset.prepareRays = prepared;
    check(frothOpenAsset(context_, &asset, &asset_), "frothOpenAsset");
    auto placement = makeStruct<FrothInstanceInfo>();
    placement.asset = asset_;
    check(frothCreateInstance(context_, &placement, &instance_), "frothCreateInstance");
    auto view = makeStruct<FrothViewInfo>();
    view.maxExtent = kExtent;
    check(frothCreateView(context_, &view, &view_), "frothCreateView");
    const std::vector<FrothGpuRay> rays = raysThrough({-1, -1, 2}, {1, 1, 4}, kRays, 21);
    rays_ = *device_.createBuffer(MemoryUse::kViewsHost, BufferKind::kReadback,
                                  kRays * (sizeof(FrothGpuRay) + sizeof(FrothGpuHit)), "rays and hits");
    std::memcpy(rays_.mapped, rays.data(), rays.size() * sizeof(FrothGpuRay));
  }

  // A frame of `lag` frames that the context takes for not complete yet.
  Shot shoot(uint32_t lag = 1, uint64_t uploadBytes = 0, bool isDropped = false) {
    Shot shot{makeStruct<FrothFrameStatus>(), makeStruct<FrothAssetStatus>(), makeStruct<FrothViewStatus>(), {}};
    const VkDeviceAddress hits = rays_.address + kRays * sizeof(FrothGpuRay);
    EXPECT_TRUE(sharedHost().submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
      completed_ = std::max(completed_, serial - lag);
      const FrothFrame frame{sizeof(FrothFrame), serial, completed_, uploadBytes, 0, 0, 0};
      check(frothUpdate(context_, &frame, &shot.frame), "frothUpdate");
      check(frothRecordUpload(context_, commands), "frothRecordUpload");
      const FrothWalkInfo walk = walkInfo();
      VkDescriptorSet set = VK_NULL_HANDLE;
      isWhole_ = frothRecordWalkSet(context_, commands, &walk, &set) == FROTH_OK;
      check(frothRecordRays(context_, commands, rays_.address, hits, kRays, FROTH_RAY_RADIANCE), "frothRecordRays");
      device_.table.recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                        VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                                        VK_ACCESS_2_HOST_READ_BIT);
      drawView(commands);
      check(frothGetAssetStatus(context_, asset_, &shot.asset), "frothGetAssetStatus");
      if (isDropped) check(frothDropFrame(context_, serial), "frothDropFrame");
      return {};
    }));
    shot.hits.resize(kRays);
    std::memcpy(shot.hits.data(), static_cast<const char*>(rays_.mapped) + kRays * sizeof(FrothGpuRay),
                kRays * sizeof(FrothGpuHit));
    check(frothGetViewStatus(context_, view_, &shot.view), "frothGetViewStatus");
    return shot;
  }

  // Frames until all is there, and counts of a complete frame with it.
  Shot settle() {
    Shot shot = shoot();
    for (int frame = 0; frame < kMostFrames && (!isWhole_ || isMoving()); ++frame) shot = shoot();
    EXPECT_TRUE(isWhole_);
    shoot();
    return shoot();
  }

  FrothMemoryReport report() {
    auto report = makeStruct<FrothMemoryReport>();
    EXPECT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
    return report;
  }
  uint64_t viewBytes() { return report().categories[1].granted; }

  FrothStreamStatus streaming() {
    auto status = makeStruct<FrothStreamStatus>();
    EXPECT_EQ(frothGetStreamStatus(context_, &status), FROTH_OK);
    return status;
  }
  bool isMoving() { return streaming().isSettled == 0; }

  static uint64_t preparedBytes(const FrothAssetStatus& status) {
    for (uint32_t i = 0; i < status.memoryCount; ++i) {
      if (std::string(status.memory[i].name) == "cells prepared for rays") return status.memory[i].bytes;
    }
    return 0;
  }

  static constexpr uint32_t kRays = 300;
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  std::vector<std::string> warnings_;

 private:
  void drawView(VkCommandBuffer commands) {
    HostImage& image =
        image_ ? *image_ : image_.emplace(*sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent));
    FrothRenderInfo info = infoOf(lookAt({0, 0, 0}, {0, 0, 3}, kExtent.width, kExtent.height, 0.9));
    info.colour = sharedHost().describe(image);
    EXPECT_GE(frothRecordRaster(context_, view_, commands, &info), FROTH_OK);
  }

  Device device_;
  GpuBuffer rays_;
  std::vector<uint8_t> bytes_;
  FrothInstance instance_{};
  FrothView view_{};
  static inline std::optional<HostImage> image_;
  uint64_t completed_ = 0;
  bool isWhole_ = false;
  size_t reported_ = 0;
};

std::vector<FrothGpuHit> castUnprepared(const AssetContents& contents) {
  WalkStage stage;
  stage.place(stage.open(contents));
  return stage.cast(raysThrough({-1, -1, 2}, {1, 1, 4}, 300, 21), FROTH_RAY_RADIANCE);
}

TEST_F(PreparedBudget, LoweredTakesThemAloneAndRaisedBringsThemBack) {
  open(chunkedFoam(), FROTH_PREPARE_RADIANCE);
  const Shot before = settle();
  ASSERT_EQ(before.asset.prepared, uint32_t{FROTH_PREPARE_RADIANCE});
  const uint64_t prepared = preparedBytes(before.asset), views = viewBytes(), held = before.frame.deviceBytes;
  ASSERT_GT(prepared, 0u);

  ASSERT_EQ(frothSetBudget(context_, held - prepared / 2), FROTH_OK);
  const Shot first = shoot();
  EXPECT_EQ(first.asset.prepared, uint32_t{FROTH_PREPARE_NOTHING}) << "from the first frame on";
  const Shot lowered = settle();
  EXPECT_EQ(lowered.asset.prepared, uint32_t{FROTH_PREPARE_NOTHING});
  EXPECT_EQ(preparedBytes(lowered.asset), 0u);
  EXPECT_EQ(lowered.asset.layers, before.asset.layers);
  EXPECT_EQ(viewBytes(), views);
  EXPECT_EQ(lowered.view.bits, 0u);
  EXPECT_EQ(lowered.frame.excessBytes, 0u);
  const std::vector<FrothGpuHit> expected = castUnprepared(chunkedFoam());
  EXPECT_TRUE(areSame(first.hits, expected));
  EXPECT_TRUE(areSame(lowered.hits, expected));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("prepared for rays"), std::string::npos) << warnings_[0];

  ASSERT_EQ(frothSetBudget(context_, held + prepared), FROTH_OK);
  const Shot raised = settle();
  EXPECT_EQ(raised.asset.prepared, uint32_t{FROTH_PREPARE_RADIANCE});
  EXPECT_EQ(preparedBytes(raised.asset), prepared);
  EXPECT_TRUE(areSame(raised.hits, before.hits));
  EXPECT_LE(report().devicePeak, held + prepared);
  EXPECT_EQ(warnings_.size(), 1u);
}

// What frames in flight read stays until they are complete.
TEST_F(PreparedBudget, LoweredWithFramesInFlightFreesThemOnceThoseAreComplete) {
  open(chunkedFoam(), FROTH_PREPARE_RADIANCE);
  const Shot before = settle();
  for (uint32_t frame = 0; frame < kFramesInFlight; ++frame) shoot(kFramesInFlight);
  const uint64_t held = before.frame.deviceBytes, views = viewBytes();
  const uint64_t budget = held - preparedBytes(before.asset) / 2;
  ASSERT_EQ(frothSetBudget(context_, budget), FROTH_OK);
  for (uint32_t frame = 0; frame < kFramesInFlight; ++frame) {
    const Shot shot = shoot(kFramesInFlight);
    EXPECT_EQ(shot.frame.deviceBytes, held) << "frame " << frame;
    EXPECT_EQ(shot.asset.prepared, uint32_t{FROTH_PREPARE_NOTHING});
    EXPECT_EQ(viewBytes(), views);
  }
  EXPECT_LE(shoot(kFramesInFlight).frame.deviceBytes, budget);
}

TEST_F(PreparedBudget, ThatHasNoRoomForThemOpensTheAssetWithout) {
  constexpr uint64_t kSpare = 150000;  // for what views exchange
  const AssetContents foam = bakeScene(makeRandomFoam(900, 2, 1, 3), "exact", 256);
  open(foam, FROTH_PREPARE_NOTHING);
  const uint64_t budget = settle().frame.deviceBytes + kSpare;
  TearDown();
  open(foam, FROTH_PREPARE_RADIANCE, budget);
  const Shot shot = settle();
  EXPECT_EQ(shot.asset.state, FROTH_ASSET_READY);
  EXPECT_EQ(shot.asset.prepared, uint32_t{FROTH_PREPARE_NOTHING});
  EXPECT_EQ(shot.view.bits, 0u) << "the view has all that it wants";
  EXPECT_EQ(warnings_.size(), 1u) << "told once";
  EXPECT_LE(report().devicePeak, budget);
  ASSERT_EQ(frothSetBudget(context_, 0), FROTH_OK);
  const Shot raised = settle();
  EXPECT_EQ(raised.asset.prepared, uint32_t{FROTH_PREPARE_RADIANCE});
  EXPECT_GT(preparedBytes(raised.asset), kSpare);
}

// A frame prepares no more than it may upload, but for one chunk; rays take nothing as prepared before all is.
TEST_F(PreparedBudget, RaisedPreparesWithinTheBytesOfUploads) {
  open(chunkedFoam(), FROTH_PREPARE_VISIBILITY);
  const Shot before = settle();
  const uint64_t prepared = preparedBytes(before.asset), held = before.frame.deviceBytes;
  ASSERT_GT(before.asset.chunkCount, 3u);
  ASSERT_EQ(frothSetBudget(context_, held - prepared), FROTH_OK);
  const Shot lowered = settle();
  ASSERT_EQ(frothSetBudget(context_, 2 * held), FROTH_OK);
  for (uint32_t frame = 1; frame < before.asset.chunkCount; ++frame) {
    const Shot shot = shoot(1, 1);
    EXPECT_EQ(shot.asset.prepared, uint32_t{FROTH_PREPARE_NOTHING}) << "frame " << frame;
    EXPECT_TRUE(areSame(shot.hits, lowered.hits));
  }
  const Shot whole = shoot(1, 1);
  EXPECT_EQ(whole.asset.prepared, uint32_t{FROTH_PREPARE_VISIBILITY});
  EXPECT_TRUE(areSame(whole.hits, before.hits));
}

TEST_F(PreparedBudget, DroppedFramesPrepareThemAgain) {
  open(chunkedFoam(), FROTH_PREPARE_RADIANCE);
  const Shot before = settle();
  const uint64_t held = before.frame.deviceBytes;
  ASSERT_EQ(frothSetBudget(context_, held - preparedBytes(before.asset)), FROTH_OK);
  settle();
  ASSERT_EQ(frothSetBudget(context_, 2 * held), FROTH_OK);
  const Shot dropped = shoot(1, 1, true);
  EXPECT_EQ(dropped.asset.prepared, uint32_t{FROTH_PREPARE_NOTHING}) << "one chunk of several";
  for (uint32_t frame = 1; frame < before.asset.chunkCount; ++frame) {
    EXPECT_EQ(shoot(1, 1).asset.prepared, uint32_t{FROTH_PREPARE_NOTHING});
  }
  const Shot whole = shoot(1, 1);
  EXPECT_EQ(whole.asset.prepared, uint32_t{FROTH_PREPARE_RADIANCE});
  EXPECT_TRUE(areSame(whole.hits, before.hits));
}

TEST_F(PreparedBudget, LoweredBelowAllLevelsTakesThemBeforeTheCutGetsCoarser) {
  open(makeLevelSample(), FROTH_PREPARE_RADIANCE);
  const Shot before = settle();
  ASSERT_EQ(before.asset.prepared, uint32_t{FROTH_PREPARE_RADIANCE});
  const uint32_t chunks = streaming().drawnChunks;
  const uint64_t views = viewBytes();
  ASSERT_EQ(frothSetBudget(context_, before.frame.deviceBytes - preparedBytes(before.asset) / 2), FROTH_OK);
  const Shot lowered = settle();
  EXPECT_EQ(lowered.asset.prepared, uint32_t{FROTH_PREPARE_NOTHING});
  EXPECT_EQ(streaming().drawnChunks, chunks);
  EXPECT_EQ(viewBytes(), views);
  EXPECT_EQ(lowered.frame.excessBytes, 0u);
  ASSERT_EQ(frothSetBudget(context_, 0), FROTH_OK);
  const Shot raised = settle();
  EXPECT_EQ(raised.asset.prepared, uint32_t{FROTH_PREPARE_RADIANCE});
  EXPECT_TRUE(areSame(raised.hits, before.hits));
}

}  // namespace
}  // namespace froth::test
