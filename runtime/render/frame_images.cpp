#include "runtime/render/frame_images.h"

#include <algorithm>

namespace froth {
namespace {

constexpr VkFormat kColourFormats[] = {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
constexpr VkFormat kHalf4[] = {VK_FORMAT_R16G16B16A16_SFLOAT};
constexpr VkFormat kHalf2[] = {VK_FORMAT_R16G16_SFLOAT};
constexpr VkFormat kByte1[] = {VK_FORMAT_R8_UNORM};
constexpr VkFormat kFloat1[] = {VK_FORMAT_R32_SFLOAT};
constexpr VkFormat kFloat4[] = {VK_FORMAT_R32G32B32A32_SFLOAT};
constexpr VkFormat kUint2[] = {VK_FORMAT_R32G32_UINT};
constexpr VkFormat kDepthFormats[] = {VK_FORMAT_D32_SFLOAT,        VK_FORMAT_D32_SFLOAT_S8_UINT,
                                      VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_X8_D24_UNORM_PACK32,
                                      VK_FORMAT_D16_UNORM,         VK_FORMAT_R32_SFLOAT};

using Info = const FrothRenderInfo&;

}  // namespace

const std::array<FrameImage, kFrameImageCount> kFrameImages = {{
    {"colour", [](Info info) -> const FrothImage& { return info.colour; }, ImageRole::kDrawn, gpu::kFlagColour, false,
     kColourFormats, "R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT"},
    {"distance", [](Info info) -> const FrothImage& { return info.distance; }, ImageRole::kDrawn, gpu::kFlagDistance,
     false, kFloat1, "R32_SFLOAT"},
    {"normal", [](Info info) -> const FrothImage& { return info.normal; }, ImageRole::kDrawn, gpu::kFlagNormal, true,
     kHalf4, "R16G16B16A16_SFLOAT"},
    {"depth", [](Info info) -> const FrothImage& { return info.depth; }, ImageRole::kDrawn, gpu::kFlagDepth, true,
     kFloat1, "R32_SFLOAT"},
    {"camera.lens.rayMap", [](Info info) -> const FrothImage& { return info.camera.lens.rayMap; }, ImageRole::kRead, 0,
     false, kFloat4, "R32G32B32A32_SFLOAT"},
    {"sceneDepth", [](Info info) -> const FrothImage& { return info.sceneDepth; }, ImageRole::kRead,
     gpu::kFlagSceneDepth, true, kDepthFormats,
     "D32_SFLOAT, D32_SFLOAT_S8_UINT, D24_UNORM_S8_UINT, X8_D24_UNORM_PACK32, D16_UNORM or R32_SFLOAT"},
    {"id", [](Info info) -> const FrothImage& { return info.id; }, ImageRole::kOfHits, 0, true, kUint2, "R32G32_UINT"},
    {"motion", [](Info info) -> const FrothImage& { return info.motion; }, ImageRole::kOfHits, 0, true, kHalf2,
     "R16G16_SFLOAT"},
    {"reactive", [](Info info) -> const FrothImage& { return info.reactive; }, ImageRole::kOfHits, gpu::kFlagQuarters,
     true, kByte1, "R8_UNORM"},
}};

static_assert(gpu::kBindingColour == 0 && gpu::kBindingDistance == 1 && gpu::kBindingNormal == 2 &&
              gpu::kBindingDepth == 3 && gpu::kBindingRayMap == 4 && gpu::kBindingSceneDepth == 5 &&
              gpu::kBindingCount == 6);

uint32_t imageFlags(const FrothRenderInfo& info) {
  uint32_t flags = 0;
  for (const FrameImage& image : kFrameImages) {
    if (image.of(info).image) flags |= image.flag;
  }
  return flags;
}

bool hasRole(const FrothRenderInfo& info, ImageRole role) {
  return std::ranges::any_of(kFrameImages,
                             [&](const FrameImage& image) { return image.role == role && image.of(info).image; });
}

bool isFullFrame(const FrothRenderInfo& info) {
  return info.toneCurve != FROTH_TONE_NONE || std::ranges::any_of(kFrameImages, [&](const FrameImage& image) {
           return image.isFull && image.of(info).image;
         });
}

}  // namespace froth
