#include "runtime/render/pass_recorder.h"

#include <utility>

namespace froth {

void PassRecorder::bind(Pass pass) const {
  vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines[static_cast<uint32_t>(pass)]);
}

void PassRecorder::run(Pass pass, uint32_t groupsX, uint32_t groupsY, uint32_t mode) const {
  bind(pass);
  const gpu::PassConstants constants{frame, mode, 0};
  vk.vkCmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
  vk.vkCmdDispatch(commandBuffer, groupsX, groupsY, 1);
}

void PassRecorder::runIndirect(Pass pass, size_t dispatch) const {
  bind(pass);
  const gpu::PassConstants constants{frame, 0, 0};
  vk.vkCmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
  dispatchIndirect(dispatch);
}

void PassRecorder::dispatchIndirect(size_t dispatch) const {
  vk.vkCmdDispatchIndirect(commandBuffer, counters, countersOffset + dispatch);
}

void PassRecorder::wait() const {
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                             VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

void recordSort(const PassRecorder& recorder, const SortArrays& arrays, uint32_t digits) {
  gpu::SortConstants constants{
      recorder.frame, arrays.keys, arrays.values,  arrays.keysSwap, arrays.valuesSwap,
      arrays.count,   0,           arrays.capacity};
  for (uint32_t digit = 0; digit < digits; ++digit) {
    constants.shift = 8 * digit;
    recorder.vk.vkCmdPushConstants(recorder.commandBuffer, recorder.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                   sizeof(constants), &constants);
    recorder.bind(Pass::kSortHistogram);
    recorder.dispatchIndirect(arrays.dispatch);
    recorder.wait();
    recorder.bind(Pass::kSortScan);
    recorder.vk.vkCmdDispatch(recorder.commandBuffer, gpu::kGroupSize, 1, 1);
    recorder.wait();
    recorder.bind(Pass::kSortScatter);
    recorder.dispatchIndirect(arrays.dispatch);
    recorder.wait();
    std::swap(constants.keysIn, constants.keysOut);
    std::swap(constants.valuesIn, constants.valuesOut);
  }
}

}  // namespace froth
