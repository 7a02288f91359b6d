// From the state in which a caller hands an image over to Froth's use of it, and on to the state in which he wants it
// back.
#pragma once

#include "froth/froth.h"

namespace froth {

struct ImageUse {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
  VkImageLayout layout;
};

inline constexpr ImageUse kImageWritten = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                           VK_IMAGE_LAYOUT_GENERAL};
inline constexpr ImageUse kImageSampled = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                           VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

VkImageMemoryBarrier2 entryBarrier(const FrothImage& image, const ImageUse& use);
VkImageMemoryBarrier2 exitBarrier(const FrothImage& image, const ImageUse& use);
// Of a colour image; stages, accesses and layouts are left to the caller.
VkImageMemoryBarrier2 barrierOf(VkImage image);

}  // namespace froth
