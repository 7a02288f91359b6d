// Two eyes of one view: each the same bits as a view of its own draws, into rectangles of one image or layers of one.
#include <gtest/gtest.h>

#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kEye{96, 64};

View viewOf(uint32_t eye) {
  return lookAt({eye == 0 ? -0.03 : 0.03, 0.1, -0.5}, {0, 0, 3}, kEye.width, kEye.height, 0.5);
}

Stage& stage() {
  static FrothContext* const context = createCheckedContext(0);
  static Stage* const made = new Stage(bakeForTest(makeRandomFoam(500, 4, 2, 9)), kEye, context, 0, 0, false, 2);
  return *made;
}

// The image's colours within a rectangle.
std::vector<float> partOf(const std::vector<float>& texels, uint32_t width, uint32_t left) {
  std::vector<float> part;
  for (uint32_t y = 0; y < kEye.height; ++y) {
    const auto row = texels.begin() + 4 * (y * width + left);
    part.insert(part.end(), row, row + 4 * kEye.width);
  }
  return part;
}

std::vector<float> drawnAlone(Method method, uint32_t eye) {
  HostImage image = *sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kEye);
  FrothRenderInfo info = infoOf(viewOf(eye));
  info.colour = sharedHost().describe(image);
  stage().submit(method, info);
  std::vector<float> texels = *sharedHost().readImage(image);
  sharedHost().destroyImage(image);
  return texels;
}

TEST(Eyes, AreDrawnIntoRectanglesOfOneImageInOneFrame) {
  HostImage image = *sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, {2 * kEye.width, kEye.height});
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    std::vector<std::pair<Method, FrothRenderInfo>> draws;
    for (uint32_t eye = 0; eye < 2; ++eye) {
      FrothRenderInfo info = infoOf(viewOf(eye));
      info.eye = eye;
      info.camera.viewport.x = static_cast<float>(eye * kEye.width);
      info.colour = eye == 0 ? sharedHost().describe(image) : sharedHost().describeInput(image);  // keeps the other eye
      info.colour.stageIn = info.colour.stageOut = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
      info.colour.accessIn = info.colour.accessOut = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
      draws.emplace_back(method, info);
    }
    const FrothViewStatus status = stage().submit(draws);
    EXPECT_EQ(status.bits, 0u);
    const std::vector<float> texels = *sharedHost().readImage(image);
    for (uint32_t eye = 0; eye < 2; ++eye) {
      EXPECT_EQ(partOf(texels, 2 * kEye.width, eye * kEye.width), drawnAlone(method, eye)) << "eye " << eye;
    }
    EXPECT_NE(drawnAlone(method, 0), drawnAlone(method, 1));
  }
  sharedHost().destroyImage(image);
}

// An image of two layers, and a view of each.
class Layers {
 public:
  Layers() {
    Host& host = sharedHost();
    host_ = *host.createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kEye, 2);
    for (uint32_t layer = 0; layer < 2; ++layer) {
      VkImageViewCreateInfo info{};
      info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
      info.image = host_.image;
      info.viewType = VK_IMAGE_VIEW_TYPE_2D;
      info.format = host_.format;
      info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, layer, 1};
      EXPECT_EQ(vkCreateImageView(host.device, &info, nullptr, &views_[layer]), VK_SUCCESS);
    }
  }
  ~Layers() {
    for (const VkImageView view : views_) vkDestroyImageView(sharedHost().device, view, nullptr);
    sharedHost().destroyImage(host_);
  }

  FrothImage describe(uint32_t layer) const {
    FrothImage image = sharedHost().describe(host_);
    image.view = views_[layer];
    image.layer = layer;
    return image;
  }
  std::vector<float> read(uint32_t layer) const { return *sharedHost().readImage(host_, layer); }

 private:
  HostImage host_;
  VkImageView views_[2] = {};
};

TEST(Eyes, AreDrawnIntoLayersOfOneImageInOneFrame) {
  const Layers layers;
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    std::vector<std::pair<Method, FrothRenderInfo>> draws;
    for (uint32_t eye = 0; eye < 2; ++eye) {
      FrothRenderInfo info = infoOf(viewOf(eye));
      info.eye = eye;
      info.colour = layers.describe(eye);
      draws.emplace_back(method, info);
    }
    stage().submit(draws);
    for (uint32_t eye = 0; eye < 2; ++eye) EXPECT_EQ(layers.read(eye), drawnAlone(method, eye)) << "eye " << eye;
  }
}

}  // namespace
}  // namespace froth::test
