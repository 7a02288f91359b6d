// A queue of an engine whose submissions signal the values 1, 2, 3 ... of a timeline semaphore.
#pragma once

#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "host/host.h"

namespace froth {

// A device with queues of several families, as far as it has them, and timeline semaphores; see sharedHost().
inline Host* hostOfSeveralQueues() {
  static const Result<std::unique_ptr<Host>> host =
      Host::create({.device = "", .useValidation = true, .useGraphics = true, .useOtherQueues = true});
  EXPECT_TRUE(host) << host.error().message;
  return host ? host->get() : nullptr;
}

class TimelineQueue {
 public:
  TimelineQueue(const Host& host, const HostQueue& queue) : device_(host.device), queue_(queue) {
    VkSemaphoreTypeCreateInfo typeInfo{};
    typeInfo.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
    typeInfo.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphoreInfo{};
    semaphoreInfo.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    semaphoreInfo.pNext = &typeInfo;
    EXPECT_EQ(vkCreateSemaphore(device_, &semaphoreInfo, nullptr, &semaphore_), VK_SUCCESS);
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = queue.family;
    EXPECT_EQ(vkCreateCommandPool(device_, &poolInfo, nullptr, &pool_), VK_SUCCESS);
  }
  ~TimelineQueue() {
    vkDeviceWaitIdle(device_);
    vkDestroyCommandPool(device_, pool_, nullptr);
    vkDestroySemaphore(device_, semaphore_, nullptr);
  }
  TimelineQueue(const TimelineQueue&) = delete;
  TimelineQueue& operator=(const TimelineQueue&) = delete;

  // What a submission waits for; value 0: for nothing.
  VkSemaphoreSubmitInfo reached(uint64_t value, VkPipelineStageFlags2 stages) const {
    VkSemaphoreSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
    info.semaphore = semaphore_;
    info.value = value;
    info.stageMask = stages;
    return info;
  }

  // Records and submits; signals nextValue().
  void submit(const std::vector<VkSemaphoreSubmitInfo>& waits, const std::function<void(VkCommandBuffer)>& body) {
    submit(record(body), waits);
  }

  // A command buffer that stays as long as the queue.
  VkCommandBuffer record(const std::function<void(VkCommandBuffer)>& body) {
    VkCommandBufferAllocateInfo bufferInfo{};
    bufferInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    bufferInfo.commandPool = pool_;
    bufferInfo.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    EXPECT_EQ(vkAllocateCommandBuffers(device_, &bufferInfo, &commands), VK_SUCCESS);
    VkCommandBufferBeginInfo beginInfo{};
    beginInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    beginInfo.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    EXPECT_EQ(vkBeginCommandBuffer(commands, &beginInfo), VK_SUCCESS);
    body(commands);
    EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    return commands;
  }

  void submit(VkCommandBuffer commands, const std::vector<VkSemaphoreSubmitInfo>& waits) {
    VkCommandBufferSubmitInfo bufferInfo{};
    bufferInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    bufferInfo.commandBuffer = commands;
    const VkSemaphoreSubmitInfo signal = reached(++submitted_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    info.waitSemaphoreInfoCount = static_cast<uint32_t>(waits.size());
    info.pWaitSemaphoreInfos = waits.data();
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &bufferInfo;
    info.signalSemaphoreInfoCount = 1;
    info.pSignalSemaphoreInfos = &signal;
    EXPECT_EQ(vkQueueSubmit2(queue_.queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
  }

  void signal(uint64_t value) const {  // by the CPU
    VkSemaphoreSignalInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO;
    info.semaphore = semaphore_;
    info.value = value;
    EXPECT_EQ(vkSignalSemaphore(device_, &info), VK_SUCCESS);
  }

  uint64_t nextValue() const { return submitted_ + 1; }
  uint64_t completedValue() const {
    uint64_t value = 0;
    EXPECT_EQ(vkGetSemaphoreCounterValue(device_, semaphore_, &value), VK_SUCCESS);
    return value;
  }
  // False: not within ten seconds.
  bool wait(uint64_t value) const {
    VkSemaphoreWaitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
    info.semaphoreCount = 1;
    info.pSemaphores = &semaphore_;
    info.pValues = &value;
    return vkWaitSemaphores(device_, &info, 10'000'000'000) == VK_SUCCESS;
  }
  bool waitForAll() const { return wait(submitted_); }

 private:
  VkDevice device_;
  HostQueue queue_;
  VkSemaphore semaphore_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  uint64_t submitted_ = 0;
};

}  // namespace froth
