// The first frame of a view: whole, or the call that records it says that it may not be.
#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kOverflow = FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW;
constexpr uint32_t kCells = 18000;
constexpr VkExtent2D kExtent{32, 32};  // small beside the cells

const AssetContents& assetOfManyCells() {
  static const AssetContents asset = [] {
    Foam foam = makeRandomFoam(kCells, 1, 1, 6);
    for (float& radius : foam.radii) radius *= 0.1f;
    return bakeForTest(foam);
  }();
  return asset;
}

View viewOfAll() { return lookAt({0, 0, 0}, {0, 0, 3}, kExtent.width, kExtent.height, 0.9); }

TEST(FirstFrame, IsWholeHoweverSmallTheView) {
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    Stage stage(assetOfManyCells(), kExtent);
    const Frame first = stage.draw(method, viewOfAll());
    EXPECT_EQ(first.status.bits, 0u);
    EXPECT_GT(first.status.visibleCells, kCells * 9 / 10);
    stage.draw(method, viewOfAll());
    EXPECT_EQ(stage.draw(method, viewOfAll()).colour.values, first.colour.values);
  }
}

// Views of the test's own beside that of a stage.
class OtherViews : public testing::Test {
 protected:
  OtherViews() : image_(*sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent)) {
    const FrothContextInfo info = sharedContextInfo();
    EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_OK);
    stage_.emplace(assetOfManyCells(), kExtent, context_);
  }
  ~OtherViews() override {
    stage_.reset();
    EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
    sharedHost().destroyImage(image_);
  }

  FrothView createView(uint32_t reserveCells, FrothView startLike = {}) {
    FrothViewInfo info{};
    info.structSize = sizeof(info);
    info.maxExtent = kExtent;
    info.reserveCells = reserveCells;
    info.startLike = startLike;
    FrothView view{};
    EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_OK);
    return view;
  }

  struct Drawn {
    FrothResult result = FROTH_OK;  // of the call that recorded it
    uint32_t bits = 0;              // of its status
    std::vector<float> colour;
  };

  Drawn draw(FrothView view) {
    Drawn drawn;
    FrothRenderInfo info = infoOf(viewOfAll());
    info.colour = sharedHost().describe(image_);
    for (const bool isDrawn : {true, false}) {
      EXPECT_TRUE(sharedHost().submit([&](VkCommandBuffer commands, uint64_t serial) {
        const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
        EXPECT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK);
        if (isDrawn) drawn.result = frothRecordRaster(context_, view, commands, &info);
        return Status();
      }));
    }
    FrothViewStatus status{};
    status.structSize = sizeof(status);
    EXPECT_EQ(frothGetViewStatus(context_, view, &status), FROTH_OK);
    drawn.bits = status.bits;
    drawn.colour = *sharedHost().readImage(image_);
    return drawn;
  }

  void destroy(FrothView view) { EXPECT_EQ(frothDestroyView(context_, view), FROTH_OK); }

  HostImage image_;
  FrothContext* context_ = nullptr;
  std::optional<Stage> stage_;
};

TEST_F(OtherViews, WithLessRoomSayAtOnceThatCellsMayBeMissing) {
  const FrothView view = createView(1000);
  const Drawn first = draw(view);
  EXPECT_EQ(first.result, FROTH_INCOMPLETE);
  EXPECT_EQ(first.bits, uint32_t{FROTH_VIEW_MAY_LACK_CELLS} | FROTH_VIEW_CELL_OVERFLOW);
  const Drawn second = draw(view);
  EXPECT_EQ(second.result, FROTH_OK) << "the first frame told what is wanted";
  EXPECT_EQ(second.bits, 0u);
  EXPECT_NE(second.colour, first.colour);
  destroy(view);
}

TEST_F(OtherViews, HaveTheirRoomBeforeTheirFirstFrame) {
  const auto heldBytes = [&] {
    FrothMemoryReport report{};
    report.structSize = sizeof(report);
    EXPECT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
    return report.deviceBytes;
  };
  const auto begin = [&] {
    EXPECT_TRUE(sharedHost().submit([&](VkCommandBuffer, uint64_t serial) {
      const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
      EXPECT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK);
      return Status();
    }));
  };
  stage_->draw(Method::kRaster, viewOfAll());
  for (int frame = 0; frame < 2; ++frame) begin();  // grows, and frees what was replaced
  const uint64_t without = heldBytes();
  const FrothView view = createView(0);
  const uint64_t with = heldBytes();
  EXPECT_GT(with, without + 175 * kCells);
  begin();
  EXPECT_EQ(heldBytes(), with);
  EXPECT_EQ(draw(view).bits, 0u);
  destroy(view);
}

TEST_F(OtherViews, StartWithWhatAnOlderOneWanted) {
  const FrothView old = createView(1000);
  draw(old);
  const Drawn whole = draw(old);
  const FrothView resized = createView(1000, old);
  destroy(old);
  const Drawn first = draw(resized);
  EXPECT_EQ(first.result, FROTH_OK);
  EXPECT_EQ(first.bits, 0u);
  EXPECT_EQ(first.colour, whole.colour);
  destroy(resized);
}

TEST_F(OtherViews, DrawWhatABudgetHasRoomForAndSaySo) {
  FrothMemoryReport report{};
  report.structSize = sizeof(report);
  ASSERT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
  // Room for a third of what the stage's view holds.
  ASSERT_EQ(frothSetBudget(context_, report.deviceBytes + report.categories[1].granted / 3), FROTH_OK);
  const FrothView view = createView(0);
  for (int frame = 0; frame < 3; ++frame) {
    const Drawn drawn = draw(view);
    EXPECT_EQ(drawn.result, FROTH_INCOMPLETE) << frame;
    EXPECT_EQ(drawn.bits & ~uint32_t{FROTH_VIEW_PAIR_OVERFLOW},
              uint32_t{FROTH_VIEW_MAY_LACK_CELLS} | FROTH_VIEW_CELL_OVERFLOW);
    EXPECT_GT(*std::max_element(drawn.colour.begin(), drawn.colour.end()), 0.0f) << "some is drawn";
  }
  ASSERT_EQ(frothSetBudget(context_, 0), FROTH_OK);
  EXPECT_EQ(draw(view).result, FROTH_OK) << "all cells have room again";
  destroy(view);
}

TEST_F(OtherViews, StartLikeNoneThatIsDestroyed) {
  const FrothView old = createView(0);
  destroy(old);
  FrothViewInfo info{};
  info.structSize = sizeof(info);
  info.maxExtent = kExtent;
  info.startLike = old;
  FrothView view{};
  EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_ERROR_HANDLE);
}

}  // namespace
}  // namespace froth::test
