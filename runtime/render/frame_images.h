// The images of a frame, a row each: what the caller may give, and who writes or reads it. The checks of a call,
// descriptor sets, barriers and the shaders' flags follow from the rows.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "froth/froth.h"
#include "shaders/gpu/layout.h"

namespace froth {

enum class ImageRole {
  kDrawn,   // written by raster, walk and clear, through their descriptor set
  kRead,    // read by them, through the same
  kOfHits,  // written by a pass of its own, from hits
};

struct FrameImage {
  const char* name;  // of the field
  const FrothImage& (*of)(const FrothRenderInfo& info);
  ImageRole role;
  uint32_t flag;  // gpu::kFlag... by which shaders know that it is there; 0: they need not
  bool isFull;    // takes more than colour and distance (gpu::kConstantIsFull)
  std::span<const VkFormat> formats;
  const char* formatNames;  // for messages
};

inline constexpr uint32_t kFrameImageCount = 9;

// Those of the descriptor set come first, each at its gpu::kBinding...
extern const std::array<FrameImage, kFrameImageCount> kFrameImages;

// The rows of the descriptor set.
inline std::span<const FrameImage> boundImages() { return std::span(kFrameImages).first(gpu::kBindingCount); }

inline VkDescriptorType descriptorTypeOf(const FrameImage& image) {
  return image.role == ImageRole::kRead ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

// Of the images that a frame has.
uint32_t imageFlags(const FrothRenderInfo& info);
bool hasRole(const FrothRenderInfo& info, ImageRole role);

// Whether a frame takes more than colour and distance.
bool isFullFrame(const FrothRenderInfo& info);

// Whether a frame asks for images that are made from hits.
inline bool wantsHits(const FrothRenderInfo& info) { return hasRole(info, ImageRole::kOfHits); }

// Whether it asks for the movement since the frame before.
inline bool wantsMotion(const FrothRenderInfo& info) { return info.motion.image || info.reactive.image; }

// Whether the passes that write rgba32f are meant; else rgba16f, also where no colour is wanted.
inline bool isWideColour(const FrothRenderInfo& info) {
  return info.colour.image && info.colour.format == VK_FORMAT_R32G32B32A32_SFLOAT;
}

}  // namespace froth
