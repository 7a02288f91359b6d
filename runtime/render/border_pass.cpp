#include "runtime/render/border_pass.h"

#include <algorithm>

#include "runtime/render/pass_recorder.h"
#include "runtime/render/view_capacity.h"

namespace froth {

void recordBorders(const Device& device, RenderPipelines& pipelines, VkCommandBuffer commandBuffer,
                   const GpuAsset& asset, const ChunkSlots::Publication& publication) {
  if (publication.slots.empty()) return;
  const DeviceTable& vk = device.table;
  vk.beginLabel(commandBuffer, "froth borders");
  constexpr VkPipelineStageFlags2 kWriters =
      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                         kWriters, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
  if (publication.isTableNew) {
    vk.vkCmdFillBuffer(commandBuffer, asset.borderBuffer, asset.borderOffset, asset.borderBytes(), gpu::kNoCell);
    vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                           VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  }
  const RenderPipelines::State& state = pipelines.state();
  vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE,
                       state.common[gpu::kLensClassPinhole][static_cast<uint32_t>(Pass::kPublishBorders)]);
  for (const uint32_t slot : publication.slots) {
    const GpuChunk& chunk = asset.chunks[slot];
    const gpu::BorderConstants constants{.borders = asset.borders,
                                         .borderCells = chunk.borderCells,
                                         .borderNumbers = chunk.borderNumbers,
                                         .count = chunk.borderCount,
                                         .firstCode = asset.localBits < 32 ? slot << asset.localBits : 0,
                                         .slot = slot,
                                         .slotPlace = asset.borderCount + chunk.number};
    vk.vkCmdPushConstants(commandBuffer, state.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), &constants);
    dispatchGroups(vk, commandBuffer, std::max(groupsOver(chunk.borderCount, gpu::kGroupSize), 1u));
  }
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
  vk.endLabel(commandBuffer);
}

}  // namespace froth
