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
    const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
    place({purpose, std::shared_ptr<const void>(owner, owner->data()), size, owner->size() * sizeof(T), address});
  }

 private:
  void place(ChunkArray&& array) {
    constexpr VkDeviceSize kAlignment = GpuArena::kAlignment;
    if (array.size == 0) return;
    size += (array.size + kAlignment - 1) / kAlignment * kAlignment;
    arrays.push_back(std::move(array));
  }
};

}  // namespace froth
