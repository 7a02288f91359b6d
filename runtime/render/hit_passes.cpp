#include "runtime/render/hit_passes.h"

#include <cstring>

#include "runtime/render/frame_images.h"
#include "runtime/render/hit_block.h"

namespace froth {
namespace {

constexpr VkDeviceSize kHitInstancesOffset = gpu::kHitBlockOffset + 288;
static_assert(gpu::kHitBlockOffset + sizeof(gpu::HitBlock) <= kHitInstancesOffset && kHitInstancesOffset % 16 == 0);
static_assert(kHitInstancesOffset + gpu::kMostInstances * sizeof(gpu::HitInstance) <= kBlockStride);

// Of all instances of the view.
VkDeviceAddress addressOfHits(const ViewState& view) { return view.spaces.front()->buffers[ViewBuffer::kHits].address; }

VkDeviceAddress addressOfQuarters(const ViewState& view) {
  return view.spaces.front()->buffers[ViewBuffer::kQuarters].address;
}

// Writes `image` with a workgroup per kSubTileSize x kSubTileSize pixels. set: of the recording's kHitImages.
void recordHitPass(const Recording& recording, const ImagePass& pass, const FrothImage& image, uint32_t set) {
  const VkDescriptorImageInfo target{VK_NULL_HANDLE, image.view, VK_IMAGE_LAYOUT_GENERAL};
  const VkDeviceAddress block = recording.parts().front().recorder.frame + gpu::kHitBlockOffset;
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  pass.bind(recording.commandBuffer, recording.view.hitSets->update(kHitImages * recording.number + set, {&target, 1}),
            std::as_bytes(std::span(&block, 1)));
  recording.view.device.table.vkCmdDispatch(recording.commandBuffer, groupsOver(extent.width, gpu::kSubTileSize),
                                            groupsOver(extent.height, gpu::kSubTileSize), 1);
}

}  // namespace

void describeHits(const Recording& recording, uint32_t part, gpu::FrameBlock& block) {
  if (!wantsHits(recording.info)) return;
  block.flags |= gpu::kFlagHits;
  block.hits = addressOfHits(recording.view);
  block.quarters = addressOfQuarters(recording.view);
  block.part = part;
}

void writeHits(const Recording& recording, uint32_t part, const RenderInstance* instance) {
  if (!wantsHits(recording.info)) return;
  const RecordingPart& first = recording.parts().front();
  const ViewBuffers& buffers = first.space.buffers;
  char* staged =
      static_cast<char*>(buffers[ViewBuffer::kStaging].mapped) + recording.number * buffers.recordingStride();
  if (part == 0) {
    gpu::HitBlock hits{};
    fillHitBlock(recording.info, hits);
    hits.hits = addressOfHits(recording.view);
    hits.quarters = addressOfQuarters(recording.view);
    hits.instances = first.recorder.frame + kHitInstancesOffset;
    std::memcpy(staged + gpu::kHitBlockOffset, &hits, sizeof(hits));
  }
  if (!instance) return;
  const gpu::HitInstance described = describeHitInstance(recording.info, *instance);
  std::memcpy(staged + kHitInstancesOffset + part * sizeof(described), &described, sizeof(described));
}

void recordHitPasses(const Recording& recording) {
  const FrothRenderInfo& info = recording.info;
  if (!wantsHits(info)) return;
  recording.run("hits", [&] {
    recording.wait();
    if (info.id.image) recordHitPass(recording, *recording.pipelines.writeIds, info.id, 0);
    if (info.motion.image) recordHitPass(recording, *recording.pipelines.writeMotion, info.motion, 1);
    if (info.reactive.image) recordHitPass(recording, *recording.pipelines.writeReactive, info.reactive, 2);
  });
}

}  // namespace froth
