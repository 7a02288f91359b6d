#include "runtime/render/pass_recorder.h"

#include <algorithm>
#include <utility>

#include "runtime/render/view_capacity.h"

namespace froth {

void dispatchGroups(const DeviceTable& vk, VkCommandBuffer commandBuffer, uint32_t groups) {
  const uint32_t rows = std::max(groupsOver(groups, gpu::kMostGroupsAlong), 1u);
  vk.vkCmdDispatch(commandBuffer, groupsOver(groups, rows), rows, 1);
}

void PassRecorder::bind(Pass pass) const {
  vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, (*pipelines)[static_cast<uint32_t>(pass)]);
}

void PassRecorder::pushFrame() const {
  const gpu::PassConstants constants{frame};
  vk.vkCmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
}

void PassRecorder::run(Pass pass, uint32_t groupsX, uint32_t groupsY) const {
  bind(pass);
  pushFrame();
  vk.vkCmdDispatch(commandBuffer, groupsX, groupsY, 1);
}

void PassRecorder::runOver(Pass pass, uint32_t groups) const {
  bind(pass);
  pushFrame();
  dispatchGroups(vk, commandBuffer, groups);
}

void PassRecorder::runIndirect(Pass pass, size_t dispatch) const {
  bind(pass);
  pushFrame();
  dispatchIndirect(dispatch);
}

void PassRecorder::dispatchIndirect(size_t dispatch) const {
  vk.vkCmdDispatchIndirect(commandBuffer, counters, countersOffset + dispatch);
}

void PassRecorder::wait() const {
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                             VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

void recordSortDigit(const PassRecorder& recorder, const SortArrays& arrays, uint32_t digit, uint32_t step) {
  const uint64_t histogram = arrays.histograms + digit * histogramBytes(arrays.capacity, arrays.rounds);
  gpu::SortConstants constants{.frame = recorder.frame,
                               .keysIn = arrays.keys,
                               .valuesIn = arrays.values,
                               .keysOut = arrays.keysSwap,
                               .valuesOut = arrays.valuesSwap,
                               .count = arrays.count,
                               .histogram = histogram,
                               .nextHistogram = histogram + histogramBytes(arrays.capacity, arrays.rounds),
                               .shift = 8 * digit,
                               .capacity = arrays.capacity,
                               .step = step,
                               .padding = 0};
  if (digit % 2 != 0) {
    std::swap(constants.keysIn, constants.keysOut);
    std::swap(constants.valuesIn, constants.valuesOut);
  }
  recorder.bind(arrays.rounds == 1 ? Pass::kSortScatter : Pass::kSortScatterMany);
  recorder.vk.vkCmdPushConstants(recorder.commandBuffer, recorder.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                 sizeof(constants), &constants);
  recorder.dispatchIndirect(arrays.dispatch);
}

}  // namespace froth
