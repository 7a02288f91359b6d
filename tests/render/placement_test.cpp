// Conventions of camera and placement: what may differ in the caller's matrices without changing the image.
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{96, 72};
constexpr double kFar = 1e6;

View frontView() { return lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, kExtent.width, kExtent.height, 0.6); }

const AssetContents& randomAsset() {
  static const AssetContents contents = [] {
    Result<Foam> foam = synthesizeFoam({"random", 0, 1});
    EXPECT_TRUE(foam) << foam.error().message;
    return bakeForTest(*foam);
  }();
  return contents;
}

class Placement : public testing::Test {
 protected:
  Placement() : stage_(std::in_place, randomAsset(), kExtent), base_(stage_->draw(Method::kRaster, frontView())) {}

  Frame draw(const FrothRenderInfo& info, Method method = Method::kRaster) {
    return stage_->draw(method, info, kExtent);
  }

  std::optional<Stage> stage_;  // a context draws one instance: reset before making another stage
  Frame base_;
};

TEST_F(Placement, ANegativeViewportHeightWithAnUpwardClipAxisGivesTheSameImage) {
  FrothRenderInfo info = infoOf(frontView());
  info.camera.clipFromView[5] *= -1;
  info.camera.clipFromView[9] *= -1;
  info.camera.viewport.y = kExtent.height;
  info.camera.viewport.height *= -1;
  EXPECT_GE(psnr(draw(info).colour, base_.colour), 100);
}

TEST_F(Placement, ViewAxesOfOpenGlGiveTheSameImage) {
  FrothRenderInfo info = infoOf(frontView());
  for (int column = 0; column < 3; ++column) {  // view y and z change sign
    info.camera.viewFromWorld[3 * column + 1] *= -1;
    info.camera.viewFromWorld[3 * column + 2] *= -1;
  }
  for (int row = 0; row < 4; ++row) {
    info.camera.clipFromView[4 + row] *= -1;
    info.camera.clipFromView[8 + row] *= -1;
  }
  EXPECT_GE(psnr(draw(info).colour, base_.colour), 100);
}

TEST_F(Placement, TheDepthRowOfTheProjectionDoesNotMatter) {
  FrothRenderInfo info = infoOf(frontView());
  info.camera.clipFromView[10] = 1.001f;  // forward depth, finite far plane
  info.camera.clipFromView[14] = -0.1f;
  EXPECT_EQ(draw(info).colour.values, base_.colour.values);
}

TEST_F(Placement, AnOffCentreProjectionShowsItsPartOfTheImage) {
  View right = frontView();
  right.width /= 2;
  right.cx -= right.width;
  const Frame part = stage_->draw(Method::kRaster, infoOf(right), {right.width, right.height});
  Image expected{right.width, right.height, 3, {}};
  for (uint32_t y = 0; y < right.height; ++y) {
    const float* row = base_.colour.pixel(right.width, y);
    expected.values.insert(expected.values.end(), row, row + 3 * right.width);
  }
  EXPECT_GE(psnr(part.colour, expected), 100);
}

TEST_F(Placement, JitterMovesTheImageByThatManyPixels) {
  FrothRenderInfo info = infoOf(frontView());
  info.camera.jitter[0] = 3;
  info.camera.jitter[1] = -2;
  const Frame moved = draw(info);
  double largest = 0;
  for (uint32_t y = 0; y + 2 < kExtent.height; ++y) {
    for (uint32_t x = 3; x < kExtent.width; ++x) {
      for (uint32_t c = 0; c < 3; ++c) {
        largest =
            std::max(largest, std::abs(double{moved.colour.pixel(x, y)[c]} - base_.colour.pixel(x - 3, y + 2)[c]));
      }
    }
  }
  EXPECT_LE(largest, 1e-2);  // rays through the same points, rounded differently
}

TEST_F(Placement, PixelsOutsideTheScissorKeepTheirValues) {
  Host& host = sharedHost();
  Result<HostImage> image = host.createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
  ASSERT_TRUE(image);
  FrothRenderInfo info = infoOf(frontView());
  info.colour = host.describe(*image);
  stage_->submit(Method::kRaster, info);
  info.colour.layoutIn = info.colour.layoutOut;
  info.colour.stageIn = info.colour.stageOut;
  info.colour.accessIn = info.colour.accessOut;
  info.camera.eye[0] += 0.5;
  info.camera.scissor = {{20, 10}, {41, 33}};
  const Frame other = draw(info);
  stage_->submit(Method::kRaster, info);
  const Result<std::vector<float>> texels = host.readImage(*image);
  ASSERT_TRUE(texels);
  for (uint32_t y = 0; y < kExtent.height; ++y) {
    for (uint32_t x = 0; x < kExtent.width; ++x) {
      const bool isInside = x >= 20 && x < 61 && y >= 10 && y < 43;
      const Image& expected = isInside ? other.colour : base_.colour;
      ASSERT_EQ((*texels)[4 * (y * kExtent.width + x)], expected.pixel(x, y)[0]) << x << ", " << y;
    }
  }
  host.destroyImage(*image);
}

TEST_F(Placement, AnInstanceAMillionUnitsAwayLooksTheSame) {
  stage_->place(placementOf({kFar, -kFar, kFar}, glm::vec4(0), 0));
  FrothRenderInfo info = infoOf(frontView());
  info.camera.eye[0] += kFar;
  info.camera.eye[1] -= kFar;
  info.camera.eye[2] += kFar;
  EXPECT_GE(psnr(draw(info).colour, base_.colour), 100);
  EXPECT_GE(psnr(draw(info, Method::kWalk).colour, base_.colour), 60);
}

TEST_F(Placement, ATurnedAndScaledInstanceSeenAccordinglyLooksTheSame) {
  // A quarter turn about z and twice the size: world = 2 (-y, x, z) + (5, 6, 7).
  const float half = std::sqrt(0.5f);
  stage_->place(placementOf({5, 6, 7}, {0, 0, half, half}, 2));
  FrothRenderInfo info = infoOf(frontView());
  const std::array<double, 3> eye = {info.camera.eye[0], info.camera.eye[1], info.camera.eye[2]};
  info.camera.eye[0] = -2 * eye[1] + 5;
  info.camera.eye[1] = 2 * eye[0] + 6;
  info.camera.eye[2] = 2 * eye[2] + 7;
  for (int row = 0; row < 3; ++row) {  // columns x, y of view-from-world turn with the world
    const float x = info.camera.viewFromWorld[row], y = info.camera.viewFromWorld[3 + row];
    info.camera.viewFromWorld[row] = -y;
    info.camera.viewFromWorld[3 + row] = x;
  }
  const Frame turned = draw(info);
  EXPECT_GE(psnr(turned.colour, base_.colour), 80);
  const size_t middle = size_t{kExtent.width} * (kExtent.height / 2) + kExtent.width / 2;
  EXPECT_NEAR(turned.distance.values[middle], 2 * base_.distance.values[middle], 1e-3);
  EXPECT_NEAR(turned.normal.values[3 * middle], -base_.normal.values[3 * middle + 1], 1e-2);
  EXPECT_NEAR(turned.normal.values[3 * middle + 1], base_.normal.values[3 * middle], 1e-2);
}

TEST_F(Placement, AChunkOriginAMillionUnitsAwayLooksTheSame) {
  stage_.reset();
  AssetContents contents = randomAsset();
  contents.chunks[0].origin = {kFar, kFar, -kFar};
  Stage stage(contents, kExtent);
  FrothRenderInfo info = infoOf(frontView());
  info.camera.eye[0] += kFar;
  info.camera.eye[1] += kFar;
  info.camera.eye[2] -= kFar;
  EXPECT_GE(psnr(stage.draw(Method::kRaster, info, kExtent).colour, base_.colour), 100);
  EXPECT_GE(psnr(stage.draw(Method::kWalk, info, kExtent).colour, base_.colour), 60);
}

TEST_F(Placement, AnImageWantedAloneIsTheSame) {
  Host& host = sharedHost();
  Result<HostImage> image = host.createImage(VK_FORMAT_R32_SFLOAT, kExtent);
  ASSERT_TRUE(image);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    FrothRenderInfo info = infoOf(frontView());
    info.distance = host.describe(*image);
    stage_->submit(method, info);
    const Result<std::vector<float>> texels = host.readImage(*image);
    ASSERT_TRUE(texels);
    for (size_t i = 0; i < texels->size(); ++i) {
      const float expected = base_.distance.values[i];
      if (std::isinf(expected)) {
        ASSERT_TRUE(std::isinf((*texels)[i])) << i;
      } else {
        ASSERT_NEAR((*texels)[i], expected, 1e-3) << i;
      }
    }
  }
  host.destroyImage(*image);
}

}  // namespace
}  // namespace froth::test
