// The foam in the mirror against the rasterizer, from where the mirrored camera stands.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "shaders/foam/colour.h"
#include "tests/room/reference_frame.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

// A mirrored camera is none: it becomes one by turning its x axis over, and the projection turns the image back.
FrothCamera mirroredCamera(const Room& room, const Pose& pose) {
  FrothCamera camera = cameraOf(pose, kRoomExtent);
  const glm::dmat3 axes = glm::mat3_cast(pose.worldFromCamera);
  const glm::dvec3 eye = room.mirror.reflect(pose.eye);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 mirrored = glm::reflect(axes[axis], room.mirror.normal) * (axis == 0 ? -1.0 : 1.0);
    for (int i = 0; i < 3; ++i) camera.viewFromWorld[3 * i + axis] = static_cast<float>(mirrored[i]);
    camera.eye[axis] = eye[axis];
  }
  camera.clipFromView[0] = -camera.clipFromView[0];
  return camera;
}

std::vector<float> rasterizeMirrored(RoomUnderTest& room) {
  Scene& scene = room.stage().scene();
  FrothViewInfo viewInfo{};
  viewInfo.structSize = sizeof(viewInfo);
  viewInfo.maxExtent = kRoomExtent;
  FrothView view{};
  EXPECT_EQ(frothCreateView(scene.context(), &viewInfo, &view), FROTH_OK);
  Result<HostImage> colour = room.host().createImage(VK_FORMAT_R16G16B16A16_SFLOAT, kRoomExtent);
  EXPECT_TRUE(colour) << colour.error().message;
  FrothRenderInfo info{};
  info.structSize = sizeof(info);
  info.camera = mirroredCamera(room.stage().room(), room.pose());
  info.colour = room.host().describe(*colour);
  info.sceneDepth = room.host().describeInput(room.stage().renderer().images().mirroredDepth);
  info.sceneDepth.layoutIn = info.sceneDepth.layoutOut = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  for (int frame = 0; frame < 4; ++frame) {  // the view's buffers grow in the first ones
    const Status drawn = submitFrame(room.host(), scene, [&](VkCommandBuffer commands, uint64_t) {
      return scene.check(frothRecordRaster(scene.context(), view, commands, &info), "frothRecordRaster");
    });
    EXPECT_TRUE(drawn) << drawn.error().message;
  }
  std::vector<float> texels = room.read(*colour);
  room.host().destroyImage(*colour);
  return texels;
}

TEST(Reflection, OfTheFoamIsTheRasterOfTheMirroredCamera) {
  if (!hasSuitableDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  RoomUnderTest room({.shadowCatching = 0, .occlusionReach = 0.5}, false);
  room.draw();
  const std::vector<float> walked = room.read(room.stage().renderer().images().reflection);
  const std::vector<float> rasterized = rasterizeMirrored(room);
  const RoomGeometry meshes(room.stage().room());
  double sum = 0, foam = 0, largest = 0;
  glm::uvec2 worst(0);
  uint32_t pixels = 0, steps = 0;
  for (uint32_t y = 0; y < kRoomExtent.height; ++y) {
    for (uint32_t x = 0; x < kRoomExtent.width; ++x) {
      const std::optional<MeshHit> hit = meshes.cast(room.pose().eye, pixelDirection(room.pose(), x, y), 0, INFINITY);
      if (!hit || room.stage().room().materials[hit->material].kind != MaterialKind::kMirror) continue;
      const size_t texel = 4 * (size_t{y} * kRoomExtent.width + x);
      const auto coded = [&](const std::vector<float>& texels) {
        return foam::displayPremultiplied<float>({texels[texel], texels[texel + 1], texels[texel + 2]},
                                                 texels[texel + 3]);
      };
      const glm::dvec3 difference = coded(walked) - coded(rasterized);
      sum += glm::dot(difference, difference) / 3;
      const double error = std::max({std::abs(difference.x), std::abs(difference.y), std::abs(difference.z)});
      if (error > largest) worst = {x, y};
      largest = std::max(largest, error);
      steps += error > 1 / 255.0;
      foam += rasterized[texel + 3];
      ++pixels;
    }
  }
  ASSERT_GT(pixels, 300u);
  EXPECT_GT(foam / pixels, 0.1) << "the mirror hardly shows the foam";
  const double psnr = -10 * std::log10(sum / pixels);
  EXPECT_GE(psnr, 70);  // colours as seen from where the ray is reflected: 59
  std::printf(
      "reflected foam against the raster of the mirrored camera: %.2f dB over %u pixels, largest error %.4f at (%u, "
      "%u), %u pixels above 1/255\n",
      psnr, pixels, largest, worst.x, worst.y, steps);
}

}  // namespace
}  // namespace froth::test
