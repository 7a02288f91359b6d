#include "host/frame_ring.h"

#include <algorithm>

#include "host/vulkan_check.h"

namespace froth {

Result<std::unique_ptr<FrameRing>> FrameRing::create(const Host& host) {
  std::unique_ptr<FrameRing> ring(new FrameRing(host));
  for (FrameSlot& slot : ring->slots_) {
    if (Status made = ring->createSlot(slot); !made) return made.error();
  }
  return ring;
}

FrameRing::~FrameRing() {
  for (const FrameSlot& slot : slots_) {
    vkDestroyFence(host_.device, slot.isComplete, nullptr);
    vkDestroySemaphore(host_.device, slot.isAcquired, nullptr);
    vkDestroyCommandPool(host_.device, slot.pool, nullptr);
  }
}

Status FrameRing::createSlot(FrameSlot& slot) {
  VkCommandPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  poolInfo.queueFamilyIndex = host_.queueFamily;
  Status made = checkVulkan(vkCreateCommandPool(host_.device, &poolInfo, nullptr, &slot.pool), "vkCreateCommandPool");
  if (!made) return made;
  VkCommandBufferAllocateInfo bufferInfo{};
  bufferInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  bufferInfo.commandPool = slot.pool;
  bufferInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  bufferInfo.commandBufferCount = 1;
  made = checkVulkan(vkAllocateCommandBuffers(host_.device, &bufferInfo, &slot.commands), "vkAllocateCommandBuffers");
  if (!made) return made;
  const VkSemaphoreCreateInfo semaphoreInfo{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
  made = checkVulkan(vkCreateSemaphore(host_.device, &semaphoreInfo, nullptr, &slot.isAcquired), "vkCreateSemaphore");
  if (!made) return made;
  const VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
  return checkVulkan(vkCreateFence(host_.device, &fenceInfo, nullptr, &slot.isComplete), "vkCreateFence");
}

Result<FrameSlot*> FrameRing::wait() {
  FrameSlot& slot = slots_[nextSerial() % kFramesInFlight];
  const VkResult waited = vkWaitForFences(host_.device, 1, &slot.isComplete, VK_TRUE, UINT64_MAX);
  if (Status status = checkVulkan(waited, "vkWaitForFences"); !status) return status.error();
  completed_ = std::max(completed_, slot.serial);
  return &slot;
}

Status FrameRing::begin(FrameSlot& slot) {
  Status begun = checkVulkan(vkResetCommandPool(host_.device, slot.pool, 0), "vkResetCommandPool");
  if (!begun) return begun;
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  return checkVulkan(vkBeginCommandBuffer(slot.commands, &info), "vkBeginCommandBuffer");
}

Status FrameRing::submit(FrameSlot& slot, VkSemaphore isDrawn) {
  Status status = checkVulkan(vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");
  if (!status) return status;
  VkSemaphoreSubmitInfo wait{};
  wait.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
  wait.semaphore = slot.isAcquired;
  wait.stageMask = VK_PIPELINE_STAGE_2_BLIT_BIT;
  VkSemaphoreSubmitInfo signal{};
  signal.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
  signal.semaphore = isDrawn;
  signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkCommandBufferSubmitInfo commands{};
  commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
  commands.commandBuffer = slot.commands;
  VkSubmitInfo2 info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
  info.waitSemaphoreInfoCount = 1;
  info.pWaitSemaphoreInfos = &wait;
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commands;
  info.signalSemaphoreInfoCount = 1;
  info.pSignalSemaphoreInfos = &signal;
  // Only now, right before the fence is used again: a frame that is given up before leaves it signalled.
  status = checkVulkan(vkResetFences(host_.device, 1, &slot.isComplete), "vkResetFences");
  if (!status) return status;
  status = checkVulkan(vkQueueSubmit2(host_.queue, 1, &info, slot.isComplete), "vkQueueSubmit2");
  if (status) slot.serial = ++submitted_;
  return status;
}

}  // namespace froth
