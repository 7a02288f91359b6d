// The caller's VkDevice as the runtime uses it: a function table and buffers reached by address.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include <vulkan/vulkan_core.h>

#include "base/result.h"
#include "runtime/device/device_memory.h"
#include "runtime/device/memory_orders.h"

namespace froth {

// Device-level functions the runtime calls, loaded per context: no globals, no loader symbols.
// clang-format off
#define FROTH_DEVICE_FUNCTIONS(X) \
  X(vkAllocateMemory) X(vkFreeMemory) X(vkMapMemory) X(vkCreateBuffer) X(vkDestroyBuffer) \
  X(vkGetBufferMemoryRequirements) X(vkBindBufferMemory) X(vkGetBufferDeviceAddress) \
  X(vkCreateShaderModule) X(vkDestroyShaderModule) X(vkCreateComputePipelines) X(vkDestroyPipeline) \
  X(vkCreatePipelineLayout) X(vkDestroyPipelineLayout) X(vkCreateDescriptorSetLayout) \
  X(vkDestroyDescriptorSetLayout) X(vkCreateDescriptorPool) X(vkDestroyDescriptorPool) \
  X(vkAllocateDescriptorSets) X(vkUpdateDescriptorSets) X(vkCreateQueryPool) X(vkDestroyQueryPool) \
  X(vkGetQueryPoolResults) X(vkCmdBindPipeline) X(vkCmdBindDescriptorSets) X(vkCmdPushConstants) \
  X(vkCmdDispatch) X(vkCmdDispatchIndirect) X(vkCmdPipelineBarrier2) X(vkCmdCopyBuffer) \
  X(vkCmdFillBuffer) X(vkCmdUpdateBuffer) \
  X(vkCmdResetQueryPool) X(vkCmdWriteTimestamp2) X(vkCreateImage) X(vkDestroyImage) \
  X(vkGetImageMemoryRequirements) X(vkBindImageMemory) X(vkCreateImageView) X(vkDestroyImageView) \
  X(vkCreateGraphicsPipelines) X(vkCmdBeginRendering) X(vkCmdEndRendering) X(vkCmdSetViewport) X(vkCmdSetScissor) \
  X(vkCmdSetDepthCompareOp) X(vkCmdDraw)
// clang-format on

struct DeviceTable {
#define FROTH_DECLARE(name) PFN_##name name = nullptr;
  FROTH_DEVICE_FUNCTIONS(FROTH_DECLARE)
#undef FROTH_DECLARE
  // Null where the instance has no VK_EXT_debug_utils.
  PFN_vkCmdBeginDebugUtilsLabelEXT vkCmdBeginDebugUtilsLabelEXT = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT vkCmdEndDebugUtilsLabelEXT = nullptr;
  PFN_vkSetDebugUtilsObjectNameEXT vkSetDebugUtilsObjectNameEXT = nullptr;

  // What is recorded in between bears this name in captures and messages of the validation layers.
  void beginLabel(VkCommandBuffer commandBuffer, const char* name) const;
  void endLabel(VkCommandBuffer commandBuffer) const;

  // One global memory barrier between two uses of buffers.
  void recordMemoryBarrier(VkCommandBuffer commandBuffer, VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess,
                           VkPipelineStageFlags2 toStage, VkAccessFlags2 toAccess) const;
};

enum class BufferKind {
  kDevice,    // storage, indirect, transfer source and target; reached by address
  kUploaded,  // the same, and written on the queue of uploads
  kStaging,   // host-visible, mapped, transfer source
  kReadback,  // host-visible, mapped, cached where offered; storage and transfer target
};

struct GpuBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  MemoryBlock memory;  // none where a later buffer of the same allocation has it
  VkDeviceSize size = 0;
  VkDeviceSize offset = 0;      // in its allocation
  VkDeviceAddress address = 0;  // 0 for kStaging
  void* mapped = nullptr;       // null for kDevice, kUploaded
  BufferKind kind = BufferKind::kDevice;
};

// One of several buffers that are made together.
struct BufferWish {
  VkDeviceSize size;  // 0: none is made
  const char* name;
};

// An error without a message: memory is to come, nothing was changed; ask again in the next update. It is ordered, and
// a job makes it; or the budget has no room for the order until a job has given back what was freed.
inline Error makeOrdered() { return {ErrorKind::kMemory, {}}; }
inline Error makeRoomToCome() { return {ErrorKind::kCancelled, {}}; }
inline bool isPending(const Status& status) { return !status && status.error().message.empty(); }
inline bool isOrdered(const Status& status) { return isPending(status) && status.error().kind == ErrorKind::kMemory; }

// What an allocation is for and what memory it wants.
struct MemoryWish {
  MemoryUse use;
  VkMemoryPropertyFlags required, preferred;
  VkMemoryAllocateFlags flags;
  const char* purpose;   // for messages
  bool mayExceedBudget;  // it replaces something larger that goes soon
};

// The caller's allocator; null: vkAllocateMemory.
struct MemoryCallbacks {
  FrothAllocateMemory allocate = nullptr;
  FrothFreeMemory free = nullptr;
  void* user = nullptr;
};

// By which call the device was found lost, first. Any thread.
class DeviceLoss {
 public:
  void tell(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
  }
  std::optional<Error> error() const {
    const std::lock_guard lock(mutex_);
    return error_;
  }
  bool isTold() const { return error().has_value(); }

 private:
  mutable std::mutex mutex_;
  std::optional<Error> error_;
};

// Owns nothing of the caller's. One thread at a time; any: create, createShaderModule, nameObject, explain, run.
class Device {
 public:
  static Result<Device> create(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                               VkPhysicalDevice physicalDevice, VkDevice device);

  // Fails with a message that names `purpose`, the size and the budget. size > 0.
  Result<GpuBuffer> createBuffer(MemoryUse use, BufferKind kind, VkDeviceSize size, const char* purpose);
  // Buffers that live and die together share an allocation, or as few as maxAllocationSize allows. Destroy them in
  // their order: the last of an allocation has its memory. made: [wishes.size()] empty. On failure nothing is made; the
  // message names `purpose`, or the buffer that cannot be.
  Status createBuffers(MemoryUse use, BufferKind kind, const char* purpose, std::span<const BufferWish> wishes,
                       std::span<GpuBuffer> made, bool mayExceedBudget = false);
  void destroyBuffer(GpuBuffer& buffer);  // the GPU must be done with it; resets it to empty

  // Makes an object by vkCreate... and names it; an error says for what the call was made.
  template <class Handle, class Info>
  Result<Handle> create(VkObjectType type, const char* name,
                        VkResult(VKAPI_PTR* call)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
                        const Info& info) {
    Handle handle = VK_NULL_HANDLE;
    if (const VkResult result = call(device, &info, nullptr, &handle); result != VK_SUCCESS) {
      return explainCreation(result, type, name);
    }
    nameObject(type, handle, name);
    return handle;
  }

  Result<VkShaderModule> createShaderModule(const char* name, std::span<const uint32_t> spirv);

  // "froth: " and the name, in captures, crash dumps and messages of the validation layers. Any thread, for an object
  // that no other uses.
  template <class Handle>
  void nameObject(VkObjectType type, Handle handle, const char* name) const {
    nameHandle(type, (uint64_t)handle, name);  // a pointer, or, on 32 bits, a number
  }

  // `used` of the required bytes will hold something. isPending(): not yet.
  Result<MemoryBlock> allocate(const VkMemoryRequirements& requirements, VkDeviceSize used, const MemoryWish& wish);
  void release(MemoryBlock& block);  // resets it to empty

  // What a batch of `orders` asks for. Any thread.
  void run(MemoryBatch& batch) const;
  VkDeviceSize orderedBytes() const { return orders ? orders->deviceBytes() : 0; }
  uint64_t newestOrder() const { return orders ? orders->newest() : 0; }
  void cancelOrdersBehind(uint64_t number) {
    if (orders) orders->cancelBehind(number, ledger);
  }
  void finishOrders();  // no job has a batch any more; from now on memory is taken and given back at once

  // The error of a Vulkan call that gave `result`; the text says which call, for what. Remembers a lost device.
#if defined(__GNUC__)
  __attribute__((format(printf, 3, 4)))
#endif
  Error
  explain(VkResult result, const char* format, ...);

  DeviceTable table;
  VkDevice device = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceMemoryProperties memory{};
  // to which frames, and to which uploads are submitted; may be one
  uint32_t queueFamily = 0, uploadFamily = 0;
  // valid ones, of queueFamily; 0: it takes no timestamps
  uint32_t timestampBits = 0;
  bool hasGraphics = false;                               // queueFamily
  VkDeviceSize maxAllocationSize = 0, maxBufferSize = 0;  // that the device promises to accept
  VkDeviceSize largestBuffer() const { return std::min(maxAllocationSize, maxBufferSize); }
  VkDeviceSize budget = 0;           // [bytes] 0: no limit
  VkDeviceSize roomBytes() const;    // left of the budget
  VkDeviceSize excessBytes() const;  // held beyond the budget
  uint64_t budgetRefusals = 0;       // allocations that did not fit it
  MemoryLedger ledger;
  MemoryCallbacks callbacks;
  std::shared_ptr<MemoryOrders> orders;  // null: memory is always taken and given back at once
  std::shared_ptr<DeviceLoss> loss = std::make_shared<DeviceLoss>();

 private:
  Error explainCreation(VkResult result, VkObjectType type, const char* name);
  void nameHandle(VkObjectType type, uint64_t handle, const char* name) const;
  Status checkBudget(VkDeviceSize size, const MemoryWish& wish);
  void giveBackNow(const std::vector<MemoryBlock>& blocks);
  Result<MemoryBlock> takeOrdered(MemoryOrder& order);
  Error explainAllocation(VkResult result, const MemoryBlock& block, const char* purpose);
  VkResult takeMemory(const FrothMemoryRequest& request, FrothDeviceMemory& place) const;
  VkResult allocateOwn(const FrothMemoryRequest& request, FrothDeviceMemory& place) const;
  void giveBack(const FrothDeviceMemory& place) const;
  Status createHandle(const BufferWish& wish, GpuBuffer& buffer);
  Result<size_t> shareMemory(std::span<GpuBuffer> buffers, const MemoryWish& wish);
  Status bindMemory(const MemoryBlock& block, GpuBuffer& buffer, const MemoryWish& wish);
};

}  // namespace froth
