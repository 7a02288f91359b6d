// What the samples ask of Vulkan again and again: errors from VkResults, shader modules, barriers.
#pragma once

#include <span>

#include <vulkan/vulkan.h>

#include "host/host.h"

namespace froth {

inline Status checkVulkan(VkResult result, const char* call) {
  if (result == VK_SUCCESS) return {};
  return makeError(ErrorKind::kUnsupported, "%s failed with VkResult %d", call, static_cast<int>(result));
}

inline Result<VkShaderModule> createShaderModule(VkDevice device, std::span<const uint32_t> spirv) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = spirv.size_bytes();
  info.pCode = spirv.data();
  VkShaderModule module = VK_NULL_HANDLE;
  const Status made = checkVulkan(vkCreateShaderModule(device, &info, nullptr, &module), "vkCreateShaderModule");
  if (!made) return made.error();
  return module;
}

// One image of one level, from one use to the next.
struct ImageUse {
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 access = VK_ACCESS_2_NONE;
};

inline void imageBarrier(VkCommandBuffer commands, VkImage image, const ImageUse& from, const ImageUse& to,
                         VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT) {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  barrier.oldLayout = from.layout;
  barrier.newLayout = to.layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect, 0, 1, 0, 1};
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace froth
