// Views with room for a part of what they see, by a low budget: what is smallest on screen is missing, from raster and
// walk alike.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kAllLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;

// A context whose messages tell of the budget, so they fail no test.
class Shortage : public testing::Test {
 protected:
  Shortage() {
    FrothContextInfo info = checkedContextInfo(kAllLenses);
    info.onMessage = [](void* user, FrothSeverity, FrothResult, const char*, const char* text) {
      static_cast<Shortage*>(user)->messages_.emplace_back(text);
    };
    info.messageUser = this;
    EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_OK);
  }
  ~Shortage() override { EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK); }

  std::unique_ptr<Stage> makeStage(const Foam& foam, VkExtent2D extent) {
    return std::make_unique<Stage>(bakeForTest(foam), extent, context_, 0, kAllLenses);
  }

  // All views keep this share of their memory.
  void leaveRoom(double share) {
    FrothMemoryReport report{};
    report.structSize = sizeof(report);
    ASSERT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
    ASSERT_STREQ(report.categories[1].name, "views");
    const auto lost = static_cast<uint64_t>((1 - share) * static_cast<double>(report.categories[1].granted));
    ASSERT_EQ(frothSetBudget(context_, report.deviceBytes - lost), FROTH_OK);
  }

  FrothContext* context_ = nullptr;
  std::vector<std::string> messages_;
};

// Balls side by side on a plane before the camera, a block of kBlock x kBlock pixels each.
constexpr uint32_t kAlong = 45, kBlock = 5, kPixels = kAlong * kBlock;

class ShortageThrough : public Shortage, public testing::WithParamInterface<LensKind> {
 protected:
  ShortageThrough() : view_(lookAt({0, 0, 0}, {0, 0, 20}, kPixels, kPixels, 0.05)) {
    view_.lens.kind = GetParam();
    const double pixel = 20 / view_.fx;  // on the plane
    if (GetParam() == LensKind::kOrthographic) view_.fx = view_.fy = 1 / pixel;
    foam_ = makeRandomFoam(kAlong * kAlong, 1, 0, 5);
    for (uint32_t cell = 0; cell < foam_.cellCount; ++cell) {
      const double x = (cell % kAlong + 0.5) * kBlock - 0.5 * kPixels,
                   y = (cell / kAlong + 0.5) * kBlock - 0.5 * kPixels;
      for (int axis = 0; axis < 3; ++axis) {
        const double* row = &view_.worldFromCamera[4 * axis];
        foam_.sites[cell][axis] = static_cast<float>(pixel * (x * row[0] + y * row[1]) + 20 * row[2] + row[3]);
      }
      radii_.push_back(
          std::exp2(static_cast<float>(cell * 7919 % foam_.cellCount) / foam_.cellCount));  // [pixels] 1 to 2
      foam_.radii[cell] = static_cast<float>(pixel) * radii_.back();
      foam_.densities[cell] = 2000;
      foam_.detailHeights[cell] = 1;  // the whole ball
    }
  }

  // [cell] whether its block shows anything.
  static std::vector<bool> seenIn(const Frame& frame) {
    std::vector<bool> seen(kAlong * kAlong);
    for (uint32_t pixel = 0; pixel < kPixels * kPixels; ++pixel) {
      const uint32_t cell = pixel / kPixels / kBlock * kAlong + pixel % kPixels / kBlock;
      seen[cell] = seen[cell] || frame.alpha.values[pixel] > 0.1f;
    }
    return seen;
  }

  View view_;
  Foam foam_;
  std::vector<float> radii_;
};

TEST_P(ShortageThrough, ALensLeavesOutTheSmallestCells) {
  const auto stage = makeStage(foam_, {kPixels, kPixels});
  const std::vector<bool> all = seenIn(stage->draw(Method::kRaster, view_));
  ASSERT_EQ(std::count(all.begin(), all.end(), true), foam_.cellCount);
  leaveRoom(0.6);
  const Frame raster = stage->draw(Method::kRaster, view_);
  EXPECT_EQ(raster.status.bits & ~FROTH_VIEW_MAY_LACK_CELLS, uint32_t{FROTH_VIEW_CELL_OVERFLOW});
  EXPECT_EQ(raster.status.visibleCells, foam_.cellCount);
  const std::vector<bool> seen = seenIn(raster);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), raster.status.shownCells);
  float largestMissing = 0, smallestSeen = 2;
  for (uint32_t cell = 0; cell < foam_.cellCount; ++cell) {
    if (seen[cell]) smallestSeen = std::min(smallestSeen, radii_[cell]);
    if (!seen[cell]) largestMissing = std::max(largestMissing, radii_[cell]);
  }
  // A class is a quarter of an octave; 3 % for the steps of the balls' bytes.
  EXPECT_LT(largestMissing, 1.03 * std::exp2(0.25) * smallestSeen);
  EXPECT_GT(raster.status.shownCells, foam_.cellCount / 3);
  EXPECT_EQ(seenIn(stage->draw(Method::kWalk, view_)), seen);
}

INSTANTIATE_TEST_SUITE_P(, ShortageThrough,
                         testing::Values(LensKind::kPinhole, LensKind::kFisheye, LensKind::kOrthographic));

Foam foamOfManyCells(uint32_t seed) {
  Foam foam = makeRandomFoam(9000, 1, 1, seed);
  for (float& radius : foam.radii) radius *= 0.12f;
  return foam;
}

TEST_F(Shortage, TakesTheSameCellsFromRasterAndWalkAndAlwaysTheSame) {
  const View view = lookAt({0, 0, 0}, {0, 0, 3}, 96, 96, 0.4);
  const auto stage = makeStage(foamOfManyCells(6), {view.width, view.height});
  const Frame whole = stage->draw(Method::kRaster, view);
  ASSERT_EQ(whole.status.bits, 0u);
  leaveRoom(0.5);
  stage->draw(Method::kRaster, view);  // gives up the memory
  const Frame raster = stage->draw(Method::kRaster, view), walk = stage->draw(Method::kWalk, view);
  for (const Frame* frame : {&raster, &walk}) EXPECT_NE(frame->status.bits & FROTH_VIEW_CELL_OVERFLOW, 0u);
  EXPECT_LT(raster.status.shownCells, 0.6 * raster.status.visibleCells);
  std::printf("[   PSNR   ] half of the room: %.1f dB, raster-walk %.1f dB\n", psnr(raster.colour, whole.colour),
              psnr(raster.colour, walk.colour));
  EXPECT_GE(psnr(raster.colour, walk.colour), 60);
  EXPECT_GE(psnr(raster.colour, whole.colour), 22) << "cells dropped in the order of the asset leave 17 to 19";
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(stage->draw(Method::kRaster, view).colour.values, raster.colour.values);
    EXPECT_EQ(stage->draw(Method::kWalk, view).colour.values, walk.colour.values);
  }
  ASSERT_EQ(frothSetBudget(context_, 0), FROTH_OK);
  stage->draw(Method::kRaster, view);
  const Frame again = stage->draw(Method::kRaster, view);
  EXPECT_EQ(again.status.bits, 0u);
  EXPECT_EQ(again.colour.values, whole.colour.values);
}

TEST_F(Shortage, TakesTheSmallestOfEachInstance) {
  const View view = lookAt({0, 0, 0}, {0, 0, 3}, 128, 64, 0.7);
  const auto left = makeStage(foamOfManyCells(6), {view.width, view.height});
  const auto right = makeStage(foamOfManyCells(7), {view.width, view.height});
  left->place(placementOf({-1.1, 0, 0}, {0, 0, 0, 1}, 1));
  FrothInstanceInfo second = placementOf({1.1, 0, 0}, {0, 0, 0, 1}, 1);
  second.userId = 7;
  right->place(second);
  left->draw(Method::kRaster, view);
  const Frame whole = left->draw(Method::kRaster, view);
  ASSERT_EQ(whole.status.bits, 0u);
  leaveRoom(0.5);
  left->draw(Method::kRaster, view);  // gives up the memory
  const Frame raster = left->draw(Method::kRaster, view), walk = left->draw(Method::kWalk, view);
  std::printf("[   PSNR   ] half of the room: %.1f dB, raster-walk %.1f dB\n", psnr(raster.colour, whole.colour),
              psnr(raster.colour, walk.colour));
  EXPECT_GE(psnr(raster.colour, whole.colour), 22) << "cells dropped in the order of the asset leave 17 to 19";
  EXPECT_GE(psnr(raster.colour, walk.colour), 60);
  const auto names = [](const std::string& text) {
    return text.starts_with("view {") && text.find("instance {") != std::string::npos &&
           text.find("userId 7") != std::string::npos && text.find("do not fit the device budget") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(messages_.begin(), messages_.end(), names)) << "no message names what is short";
}

}  // namespace
}  // namespace froth::test
