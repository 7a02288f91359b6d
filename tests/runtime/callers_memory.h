// A caller's allocator, and what a context reports of it.
#pragma once

#include <map>

#include "runtime_fixture.h"

namespace froth {

// A caller's allocator: hands out parts of memory at an offset, as one that allocates in blocks does.
struct CallersMemory {
  static constexpr VkDeviceSize kOffset = 1 << 16;  // a multiple of every alignment that a buffer asks for

  static VkResult allocate(void* user, const FrothMemoryRequest* request, FrothDeviceMemory* memory) {
    auto* self = static_cast<CallersMemory*>(user);
    if (self->live.size() >= self->most) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, nullptr, request->allocateFlags,
                                          0};
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags,
                                    request->requirements.size + kOffset, request->memoryTypeIndex};
    const VkResult result = vkAllocateMemory(self->device, &info, nullptr, &memory->memory);
    EXPECT_EQ(result, VK_SUCCESS);
    EXPECT_EQ(kOffset % request->requirements.alignment, 0u);
    memory->offset = kOffset;
    if (request->isMapped) {
      EXPECT_EQ(vkMapMemory(self->device, memory->memory, kOffset, VK_WHOLE_SIZE, 0, &memory->mapped), VK_SUCCESS);
    }
    memory->handle = reinterpret_cast<void*>(++self->count);
    self->live[memory->handle] = request->requirements.size;
    return VK_SUCCESS;
  }

  static void free(void* user, const FrothDeviceMemory* memory) {
    auto* self = static_cast<CallersMemory*>(user);
    EXPECT_EQ(self->live.erase(memory->handle), 1u) << "freed twice, or never given";
    vkFreeMemory(self->device, memory->memory, nullptr);
  }

  FrothContextInfo with(FrothContextInfo info) {
    info.allocateMemory = allocate;
    info.freeMemory = free;
    info.memoryUser = this;
    return info;
  }

  VkDeviceSize bytes() const {
    VkDeviceSize sum = 0;
    for (const auto& [handle, size] : live) sum += size;
    return sum;
  }

  VkDevice device = VK_NULL_HANDLE;
  size_t most = SIZE_MAX;
  std::map<void*, VkDeviceSize> live{};
  uintptr_t count = 0;
};

inline FrothMemoryReport reportOf(FrothContext* context) {
  auto report = makeStruct<FrothMemoryReport>();
  EXPECT_EQ(frothGetMemoryReport(context, &report), FROTH_OK);
  return report;
}

inline VkDeviceSize grantedIn(const FrothMemoryReport& report) {
  VkDeviceSize granted = 0;
  for (uint32_t i = 0; i < report.categoryCount; ++i) granted += report.categories[i].granted;
  return granted;
}

}  // namespace froth
