// The device budget, lowered and raised while frames are drawn.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kOverflow = FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW;

// So many visible cells that a view grows, and has much to give up.
AssetContents makeAssetOfManyCells() {
  Foam foam = makeRandomFoam(18000, 1, 1, 6);
  for (float& radius : foam.radii) radius *= 0.1f;
  return bakeForTest(foam);
}

class Budget : public testing::Test {
 protected:
  Budget() {
    FrothContextInfo info = sharedContextInfo();
    info.framesInFlight = kFramesInFlight;
    info.onMessage = [](void* user, FrothSeverity severity, FrothResult, const char*, const char* text) {
      static_cast<Budget*>(user)->messages_.emplace_back(severity, text);
    };
    info.messageUser = this;
    EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_OK);
  }
  ~Budget() override { EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK); }

  FrothMemoryReport report() {
    FrothMemoryReport report{};
    report.structSize = sizeof(report);
    EXPECT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
    return report;
  }

  FrothContext* context_ = nullptr;
  std::vector<std::pair<FrothSeverity, std::string>> messages_;
  static constexpr uint32_t kFramesInFlight = 3;
};

TEST_F(Budget, LoweredLiveIsObeyedWithinFramesAndRaisedBringsTheImageBack) {
  const View view = lookAt({0, 0, 0}, {0, 0, 3}, 32, 32, 0.9);
  Stage stage(makeAssetOfManyCells(), {view.width, view.height}, context_);
  stage.draw(Method::kRaster, view);
  const Frame whole = stage.draw(Method::kRaster, view);
  ASSERT_EQ(whole.status.bits, 0u);
  const FrothMemoryReport before = report();
  const uint64_t viewBytes = before.categories[1].granted;
  ASSERT_STREQ(before.categories[1].name, "views");

  const uint64_t budget = before.deviceBytes - viewBytes / 2;
  ASSERT_EQ(frothSetBudget(context_, budget), FROTH_OK);
  const Frame lowered = stage.draw(Method::kRaster, view);
  EXPECT_NE(lowered.status.bits & kOverflow, 0u) << "half of the view's memory cannot hold all cells";
  EXPECT_GT(lowered.status.visibleCells, 0u);
  EXPECT_LE(report().deviceBytes, budget) << "every frame was complete: it is obeyed at once";
  ASSERT_EQ(frothSetBudget(context_, budget), FROTH_OK);  // the peak from here on
  for (int frame = 0; frame < 10; ++frame) {
    EXPECT_EQ(stage.draw(Method::kRaster, view).colour.values, lowered.colour.values);
  }
  EXPECT_LE(report().devicePeak, budget);
  EXPECT_GT(report().deviceBytes, budget - viewBytes / 8) << "what fits is kept";

  ASSERT_EQ(frothSetBudget(context_, 2 * before.deviceBytes), FROTH_OK);
  stage.draw(Method::kRaster, view);
  const Frame raised = stage.draw(Method::kRaster, view);
  EXPECT_EQ(raised.status.bits, 0u);
  EXPECT_EQ(raised.colour.values, whole.colour.values);
  EXPECT_LE(report().devicePeak, 2 * before.deviceBytes);
}

// Beside what a view holds there is room for any part of what it wants, not for all of it at once.
TEST_F(Budget, RaisedALittleLetsAViewGrowPartByPart) {
  const View view = lookAt({0, 0, 0}, {0, 0, 3}, 32, 32, 0.9);
  Stage stage(makeAssetOfManyCells(), {view.width, view.height}, context_);
  stage.draw(Method::kRaster, view);
  const Frame whole = stage.draw(Method::kRaster, view);
  const FrothMemoryReport before = report();
  const uint64_t viewBytes = before.categories[1].granted;
  ASSERT_EQ(frothSetBudget(context_, before.deviceBytes - viewBytes / 2), FROTH_OK);
  EXPECT_NE(stage.draw(Method::kRaster, view).status.bits & kOverflow, 0u);
  ASSERT_LT(report().deviceBytes, before.deviceBytes - viewBytes / 2);

  const uint64_t budget = before.deviceBytes + viewBytes * 3 / 10;
  ASSERT_LT(budget, report().deviceBytes + viewBytes) << "not all at once";
  ASSERT_EQ(frothSetBudget(context_, budget), FROTH_OK);
  for (int frame = 0; frame < 3; ++frame) stage.draw(Method::kRaster, view);
  const Frame raised = stage.draw(Method::kRaster, view);
  EXPECT_EQ(raised.status.bits, 0u);
  EXPECT_EQ(raised.colour.values, whole.colour.values);
  EXPECT_LE(report().devicePeak, budget);
}

TEST_F(Budget, ThatCannotBeObeyedKeepsWhatIsPinnedAndTellsTheExcess) {
  const View view = lookAt({0, 0, 0}, {0, 0, 3}, 32, 32, 0.9);
  Stage stage(makeAssetOfManyCells(), {view.width, view.height}, context_);
  stage.draw(Method::kRaster, view);  // grows the view
  stage.draw(Method::kRaster, view);  // frees what it replaced
  ASSERT_EQ(frothSetBudget(context_, 1), FROTH_OK);
  for (int frame = 0; frame < 4; ++frame) {
    const Frame drawn = stage.draw(Method::kRaster, view);
    EXPECT_NE(drawn.status.bits & kOverflow, 0u);
    EXPECT_GT(*std::max_element(drawn.colour.values.begin(), drawn.colour.values.end()), 0.0f) << "some is drawn";
  }
  FrothFrameStatus status{};
  status.structSize = sizeof(status);
  ASSERT_TRUE(sharedHost().submit([&](VkCommandBuffer, uint64_t serial) {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
    EXPECT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
    return Status();
  }));
  EXPECT_EQ(status.excessBytes, status.deviceBytes - 1);
  const FrothMemoryReport now = report();
  EXPECT_LT(now.categories[1].granted, now.categories[1].peak / 2) << "the view gave up what it could";
  const auto isWarning = [](const auto& message) { return message.first == FROTH_SEVERITY_WARNING; };
  EXPECT_EQ(std::count_if(messages_.begin(), messages_.end(), isWarning), 1) << "told once";
}

TEST_F(Budget, LoweredWithFramesInFlightNeverHoldsMuchMoreAndNeverLeavesTheViewOut) {
  const View view = lookAt({0, 0, 0}, {0, 0, 3}, 32, 32, 0.9);
  const VkExtent2D extent{view.width, view.height};
  Stage stage(makeAssetOfManyCells(), extent, context_);
  stage.draw(Method::kRaster, view);
  stage.draw(Method::kRaster, view);
  const FrothMemoryReport before = report();
  HostImage image = *sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, extent);
  FrothRenderInfo info = infoOf(view);
  info.colour = sharedHost().describe(image);
  FrothFrameStatus status{};
  status.structSize = sizeof(status);
  uint64_t completed = sharedHost().nextSerial() - 1;
  const auto drawFrame = [&] {
    ASSERT_TRUE(sharedHost().submit([&](VkCommandBuffer commands, uint64_t serial) {
      completed = std::max(completed, serial - kFramesInFlight);  // as if the GPU lagged behind
      const FrothFrame frame{sizeof(FrothFrame), serial, completed, 0, 0, 0, 0};
      EXPECT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
      EXPECT_GE(frothRecordRaster(context_, stage.view(), commands, &info), FROTH_OK);
      return Status();
    }));
  };
  for (uint32_t frame = 0; frame < kFramesInFlight; ++frame) drawFrame();
  const uint64_t budget = before.deviceBytes - before.categories[1].granted / 2;
  ASSERT_EQ(frothSetBudget(context_, budget), FROTH_OK);
  uint32_t frames = 0;
  do {
    drawFrame();
    EXPECT_LE(status.deviceBytes, before.deviceBytes + before.categories[1].granted / 3) << "frame " << frames;
  } while (status.excessBytes > 0 && ++frames < 200);
  EXPECT_LE(status.deviceBytes, budget);
  EXPECT_GT(frames, kFramesInFlight) << "what frames use is exchanged when they are complete";
  EXPECT_LT(frames, 30u);
  sharedHost().destroyImage(image);
}

}  // namespace
}  // namespace froth::test
