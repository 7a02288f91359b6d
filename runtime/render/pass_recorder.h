// Records compute passes of one view: pipeline, push constants, dispatch, barriers between them.
#pragma once

#include <cstdint>

#include "runtime/device/device.h"
#include "runtime/render/pipeline_state.h"
#include "shaders/gpu/layout.h"

namespace froth {

// Dispatches so many workgroups or a few more, of shaders that count by linearGroup() of gpu/grid.glsl.
void dispatchGroups(const DeviceTable& vk, VkCommandBuffer commandBuffer, uint32_t groups);

struct PassRecorder {
  const DeviceTable& vk;
  VkCommandBuffer commandBuffer;
  VkPipelineLayout layout;
  const PassPipelines* pipelines;
  VkDeviceAddress frame;  // FrameBlock
  VkBuffer counters;      // Counters, and where in the buffer
  VkDeviceSize countersOffset;

  void run(Pass pass, uint32_t groupsX, uint32_t groupsY = 1) const;
  void runOver(Pass pass, uint32_t groups) const;  // a list, by linearGroup() of gpu/grid.glsl
  // dispatch: offset of the size in gpu::Counters.
  void runIndirect(Pass pass, size_t dispatch) const;
  // Later passes see what earlier ones wrote.
  void wait() const;

  void bind(Pass pass) const;
  void pushFrame() const;
  void dispatchIndirect(size_t dispatch) const;
};

// What a radix sort works on. Keys and values go to and fro between `keys`, `values` and their swaps.
struct SortArrays {
  VkDeviceAddress keys, values, keysSwap, valuesSwap;  // uint [capacity]
  VkDeviceAddress count;                               // uint: how many, at most capacity
  VkDeviceAddress histograms;  // [digits * histogramBytes(capacity, rounds)]: that of the lowest digit, then zeros
  uint32_t capacity;
  uint32_t rounds;  // FrameBlock::sortRounds
  size_t dispatch;  // offset in gpu::Counters of a size of one workgroup per rounds * kGroupSize keys
};

// Sorts stably by byte `digit` of the keys, after the bytes below it; done for all bytes the keys ascend, in the swaps
// if the bytes are odd in number. Between two digits: a barrier. step: gpu::kSort..., what the pass does besides.
void recordSortDigit(const PassRecorder& recorder, const SortArrays& arrays, uint32_t digit, uint32_t step);

}  // namespace froth
