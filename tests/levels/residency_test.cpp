// Chunks come and go while frames are in flight, and leave nothing behind.
#include <random>

#include <gtest/gtest.h>

#include "runtime/context/context.h"
#include "tests/levels/level_cuts.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent = {64, 48};
constexpr uint64_t kInFlight = 3;

// Frames are complete kInFlight - 1 frames late, as far as the context knows.
class Flight {
 public:
  Flight()
      : stage_(levelSample(), kExtent, context(), 0, 0, false, 0, false),
        image_(*sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent)) {}
  ~Flight() { sharedHost().destroyImage(image_); }

  static FrothContext* context() {
    static FrothContext* const made = [] {
      FrothContextInfo info = checkedContextInfo(0);
      info.framesInFlight = kInFlight;
      FrothContext* created = nullptr;
      check(frothCreateContext(&info, &created), "frothCreateContext");
      return created;
    }();
    return made;
  }

  void frame(bool isWalk) {
    FrothRenderInfo info = infoOf(lookAt({0.3, 0.2, -0.4}, {0, -0.1, 0.4}, kExtent.width, kExtent.height, 0.9));
    info.colour = sharedHost().describe(image_);
    const Status submitted = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t serial) -> Status {
      begin(commandBuffer, serial);
      check((isWalk ? frothRecordWalk : frothRecordRaster)(context(), stage_.view(), commandBuffer, &info), "record");
      return {};
    });
    EXPECT_TRUE(submitted) << submitted.error().message;
    FrothViewStatus status{};
    status.structSize = sizeof(status);
    check(frothGetViewStatus(context(), stage_.view(), &status), "frothGetViewStatus");
    EXPECT_EQ(status.indexViolations, 0u);
  }

  // A frame without a view.
  void upload() {
    const Status submitted = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t serial) -> Status {
      begin(commandBuffer, serial);
      return {};
    });
    EXPECT_TRUE(submitted) << submitted.error().message;
  }

  void want(const std::vector<uint32_t>& cut) { context()->setCut(stage_.asset(), cut); }
  const Asset& asset() const { return *context()->findAsset(stage_.asset()); }
  bool isDrawn(const std::vector<uint32_t>& cut) const { return std::ranges::equal(cut, asset().drawnChunks()); }
  bool isIdle() const {  // nothing comes or goes
    for (uint32_t chunk = 0; chunk < levelSample().chunks.size(); ++chunk) {
      const SlotState state = asset().chunkState(chunk);
      if (state != SlotState::kAbsent && state != SlotState::kResident) return false;
    }
    return true;
  }
  // Until nothing happens any more; returns how many frames that took.
  int settle(const std::vector<uint32_t>& cut) {
    want(cut);
    int frames = 0;
    for (; frames < 200 && !(isDrawn(cut) && isIdle()); ++frames) frame(frames % 2 == 0);
    frame(false);
    EXPECT_TRUE(isDrawn(cut) && isIdle());
    return frames;
  }
  FrothAssetStatus status() const { return stage_.assetStatus(); }

 private:
  void begin(VkCommandBuffer commandBuffer, uint64_t serial) {
    completed_ = std::max(completed_ == 0 ? serial - 1 : completed_, serial - kInFlight);
    const FrothFrame frame{sizeof(FrothFrame), serial, completed_, 0, 0, 0, 0};
    check(frothUpdate(context(), &frame, nullptr), "frothUpdate");
    check(frothRecordUpload(context(), commandBuffer), "frothRecordUpload");
  }

  Stage stage_;
  HostImage image_;
  uint64_t completed_ = 0;  // of the newest frame
};

TEST(Residency, OfAnEvictedChunkEndsOnceItsFramesAreComplete) {
  Flight flight;
  flight.settle(finestCut());
  const uint64_t fine = flight.status().deviceBytes;
  flight.settle(floorCut());
  const FrothAssetStatus floor = flight.status();
  for (uint32_t chunk = 0; chunk < levelSample().chunks.size(); ++chunk) {
    if (std::ranges::binary_search(floorCut(), chunk)) continue;
    EXPECT_EQ(flight.asset().chunkState(chunk), SlotState::kAbsent) << chunk;
  }
  flight.settle(finestCut());
  EXPECT_EQ(flight.status().deviceBytes, fine);
  flight.settle(floorCut());
  EXPECT_EQ(flight.status().deviceBytes, floor.deviceBytes);
  for (uint32_t i = 0; i < floor.memoryCount; ++i) {
    EXPECT_EQ(flight.status().memory[i].bytes, floor.memory[i].bytes) << floor.memory[i].name;
  }
}

TEST(Residency, LastsWhileAFrameInFlightMayDrawTheChunk) {
  Flight flight;
  flight.settle(finestCut());
  const uint32_t leaving = finestCut().back();
  flight.want(floorCut());
  for (int frame = 0; frame < 100 && !flight.isDrawn(floorCut()); ++frame) flight.frame(false);
  ASSERT_EQ(flight.asset().chunkState(leaving), SlotState::kLeaving);
  flight.frame(false);  // of the two frames in flight one is the last with the chunk
  EXPECT_EQ(flight.asset().chunkState(leaving), SlotState::kLeaving);
  flight.frame(false);
  EXPECT_EQ(flight.asset().chunkState(leaving), SlotState::kAbsent);
}

TEST(Residency, ChangesAThousandTimesAndLeavesNothing) {
  Flight flight;
  flight.settle(floorCut());
  const uint64_t before = flight.status().deviceBytes;
  std::mt19937 random(5);
  uint32_t drawn = 0;
  std::vector<uint32_t> cut = floorCut();
  for (int frame = 0; drawn < 1000 && frame < 20000 && !testing::Test::HasFailure(); ++frame) {
    const bool isDrawn = flight.isDrawn(cut);
    if (isDrawn || random() % 16 == 0) {  // some change their mind underway
      drawn += isDrawn;
      cut = randomCut(random);
      flight.want(cut);
    }
    if (random() % 16 == 0) {
      flight.frame(random() % 2 == 0);
    } else {
      flight.upload();
    }
  }
  EXPECT_EQ(drawn, 1000u);
  flight.settle(floorCut());
  EXPECT_EQ(flight.status().deviceBytes, before);
}

}  // namespace
}  // namespace froth::test
