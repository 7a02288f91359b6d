// Records compute passes of one view: pipeline, push constants, dispatch, barriers between them.
#pragma once

#include <cstdint>
#include <functional>

#include "runtime/core/device.h"
#include "runtime/render/pipeline_state.h"
#include "shaders/gpu/layout.h"

namespace froth {

struct PassRecorder {
  const DeviceTable& vk;
  VkCommandBuffer commandBuffer;
  VkPipelineLayout layout;
  const PassPipelines& pipelines;
  VkDeviceAddress frame;  // FrameBlock
  VkBuffer counters;      // Counters, and where in the buffer
  VkDeviceSize countersOffset;

  void run(Pass pass, uint32_t groupsX, uint32_t groupsY = 1) const;
  // dispatch: offset of the size in gpu::Counters.
  void runIndirect(Pass pass, size_t dispatch) const;
  // Later passes see what earlier ones wrote.
  void wait() const;

  void bind(Pass pass) const;
  void dispatchIndirect(size_t dispatch) const;
};

// What a radix sort works on. Keys and values go to and fro between `keys`, `values` and their swaps.
struct SortArrays {
  VkDeviceAddress keys, values, keysSwap, valuesSwap;  // uint [capacity]
  VkDeviceAddress count;                               // uint: how many, at most capacity
  VkDeviceAddress histograms;  // [digits * histogramBytes(capacity, rounds)]: that of the lowest digit, then zeros
  uint32_t capacity;
  uint32_t rounds;                                     // FrameBlock::sortRounds
  size_t dispatch;  // offset in gpu::Counters of a size of one workgroup per rounds * kGroupSize keys
};

// Sorts stably by the low `digits` bytes of the keys, ascending. Ends in the swaps if `digits` is odd. Ends
// with a barrier. lastStep: gpu::kSort..., what the pass over the last digit does besides. `recordBeside` records passes that
// run beside that over a digit, and are waited for with it.
void recordSort(const PassRecorder& recorder, const SortArrays& arrays, uint32_t digits, uint32_t lastStep,
                const std::function<void(uint32_t digit)>& recordBeside);

}  // namespace froth
