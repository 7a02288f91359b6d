// The arrays of a decoded chunk on their way into one place.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "runtime/asset/gpu_arena.h"
#include "runtime/asset/gpu_asset.h"

namespace froth {

struct ChunkArray {
  const char* purpose;                 // static storage
  std::shared_ptr<const void> bytes;   // owned
  VkDeviceSize offset, size;           // in the place
  VkDeviceAddress GpuChunk::*address;  // to be told
};

struct ChunkArrays {
  std::vector<ChunkArray> arrays;
  VkDeviceSize size = 0;  // of the place

  // Behind those before; an empty array has no place.
  template <class T>
  void add(std::vector<T>&& values, const char* purpose, VkDeviceAddress GpuChunk::*address) {
    constexpr VkDeviceSize kAlignment = GpuArena::kAlignment;
    if (values.empty()) return;
    const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
    const VkDeviceSize bytes = owner->size() * sizeof(T);
    arrays.push_back({purpose, std::shared_ptr<const void>(owner, owner->data()), size, bytes, address});
    size += (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }
};

}  // namespace froth
