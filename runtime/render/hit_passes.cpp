#include "runtime/render/hit_passes.h"

#include <cstring>

#include "runtime/render/hit_block.h"

namespace froth {
namespace {

constexpr VkDeviceSize kHitInstancesOffset = gpu::kHitBlockOffset + 288;
static_assert(gpu::kHitBlockOffset + sizeof(gpu::HitBlock) <= kHitInstancesOffset && kHitInstancesOffset % 16 == 0);
static_assert(kHitInstancesOffset + sizeof(gpu::HitInstance) <= kBlockStride);

// Writes `image` with a workgroup per kSubTileSize x kSubTileSize pixels. set: of the recording's two.
void recordHitPass(const Recording& recording, const ImagePass& pass, const FrothImage& image, uint32_t set) {
  const VkDescriptorImageInfo target{VK_NULL_HANDLE, image.view, VK_IMAGE_LAYOUT_GENERAL};
  const VkDeviceAddress block = recording.blockAddress() + gpu::kHitBlockOffset;
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  pass.bind(recording.commandBuffer, recording.view.hitSets->update(2 * recording.number + set, {&target, 1}),
            std::as_bytes(std::span(&block, 1)));
  recording.view.device.table.vkCmdDispatch(recording.commandBuffer, groupsOver(extent.width, gpu::kSubTileSize),
                                            groupsOver(extent.height, gpu::kSubTileSize), 1);
}

}  // namespace

void writeHits(const Recording& recording, const RenderInstance* instance, gpu::FrameBlock& block, char* staged) {
  if (!wantsHits(recording.info)) return;
  block.flags |= gpu::kFlagHits;
  block.hits = recording.view.buffers[ViewBuffer::kHits].address;
  gpu::HitBlock hits{};
  fillHitBlock(recording.info, hits);
  hits.hits = block.hits;
  hits.instances = recording.blockAddress() + kHitInstancesOffset;
  std::memcpy(staged + gpu::kHitBlockOffset, &hits, sizeof(hits));
  if (!instance) return;
  const gpu::HitInstance described = describeHitInstance(recording.info, *instance);
  std::memcpy(staged + kHitInstancesOffset, &described, sizeof(described));
}

void recordHitPasses(const Recording& recording, const RenderPipelines::State& pipelines) {
  const FrothRenderInfo& info = recording.info;
  if (!wantsHits(info)) return;
  recording.view.device.table.recordMemoryBarrier(
      recording.commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
  if (info.id.image) recordHitPass(recording, *pipelines.writeIds, info.id, 0);
  if (info.motion.image) recordHitPass(recording, *pipelines.writeMotion, info.motion, 1);
  recording.mark("hits");
}

}  // namespace froth
