// How every recording begins and ends, and the passes that raster and walk share.
#include <cstddef>
#include <cstring>

#include "runtime/render/camera_rays.h"
#include "runtime/render/hit_passes.h"
#include "runtime/render/view_state.h"

namespace froth {
namespace {

void writeBlock(const Recording& recording, const RenderInstance* instance) {
  const ViewBuffers& buffers = recording.view.buffers;
  char* staged =
      static_cast<char*>(buffers[ViewBuffer::kStaging].mapped) + recording.number * buffers.recordingStride();
  gpu::FrameBlock block{};
  if (!instance) {
    fillOutputs(recording.info, block);
  } else {
    fillFrame(recording.info, *instance, buffers, {recording.blockAddress(), recording.countersAddress()},
              block, reinterpret_cast<gpu::ChunkEntry*>(staged + kBlockStride));
    block.flags |= recording.kind == RecordingKind::kWalk ? gpu::kFlagWalk : 0;
  }
  writeHits(recording, instance, block, staged);
  std::memcpy(staged, &block, sizeof(block));
}

// Copies the block to the device and clears what the passes count in or only partly write.
void recordUpload(const Recording& recording, const GpuAsset* asset) {
  ViewState& view = recording.view;
  const ViewBuffers& buffers = view.buffers;
  const DeviceTable& vk = view.device.table;
  const VkDeviceSize stride = buffers.recordingStride();
  const VkBufferCopy copy{recording.number * stride, recording.place * stride, stride};
  vk.vkCmdCopyBuffer(recording.commandBuffer, buffers[ViewBuffer::kStaging].buffer,
                     buffers[ViewBuffer::kFrames].buffer, 1, &copy);
  vk.vkCmdFillBuffer(recording.commandBuffer, buffers[ViewBuffer::kCounters].buffer,
                     recording.countersOffset(), sizeof(gpu::Counters), 0);
  if (recording.kind != RecordingKind::kClear) {
    const TallyLayout tallies = layOutTallies(buffers.capacity());
    const bool isWalk = recording.kind == RecordingKind::kWalk;
    const uint64_t first = isWalk ? tallies.superSums : 0;
    const uint64_t end = isWalk ? tallies.tileSums : tallies.end;
    vk.vkCmdFillBuffer(recording.commandBuffer, buffers[ViewBuffer::kTallies].buffer, first, end - first, 0);
  }
  if (recording.kind == RecordingKind::kWalk && view.walkAsset != asset) {
    vk.vkCmdFillBuffer(recording.commandBuffer, buffers[ViewBuffer::kWalkStart].buffer, 0, VK_WHOLE_SIZE, 0);
    view.walkAsset = asset;
  }
  recording.view.device.table.recordMemoryBarrier(
      recording.commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

void recordRays(const Recording& recording, const PassRecorder& recorder) {
  const FrothCamera& camera = recording.info.camera;
  const uint32_t tilesX = tilesAlong(camera.scissor.extent.width), tilesY = tilesAlong(camera.scissor.extent.height);
  const bool isByImage = camera.lens.kind == FROTH_LENS_RAY_MAP;
  recorder.run(isByImage ? Pass::kAimRaysByImage : Pass::kAimRays, tilesX, tilesY);
  recorder.wait();
  recorder.run(Pass::kWidenCones, groupsOver(tilesX, gpu::kBlockTiles), groupsOver(tilesY, gpu::kBlockTiles));
  recorder.wait();
  recording.mark("aim");
}

}  // namespace

VkDeviceAddress Recording::blockAddress() const {
  return view.buffers[ViewBuffer::kFrames].address + place * view.buffers.recordingStride();
}

VkDeviceAddress Recording::countersAddress() const {
  return view.buffers[ViewBuffer::kCounters].address + countersOffset();
}

VkDeviceSize Recording::countersOffset() const {
  return place * kBlockStride;
}

void Recording::mark(const char* pass) const {
  if (view.timer) view.timer->mark(commandBuffer, number, pass);
}

Recording beginRecording(ViewState& view, VkCommandBuffer commandBuffer, RecordingKind kind,
                         const FrothRenderInfo& info, uint64_t serial, const RenderInstance* instance) {
  FrameSlot& slot = view.slots[view.slot];
  const uint32_t place = slot.recordings % kRecordingsPerFrame;
  Recording recording{.view = view,
                      .info = info,
                      .commandBuffer = commandBuffer,
                      .kind = kind,
                      .place = place,
                      .number = view.slot * kRecordingsPerFrame + place};
  slot.serial = serial;
  slot.recordings = place + 1;
  view.lastSerial = serial;

  view.images->enter(commandBuffer, info);
  if (view.timer) view.timer->begin(commandBuffer, recording.number);
  writeBlock(recording, instance);
  recordUpload(recording, instance ? instance->asset : nullptr);
  return recording;
}

PassRecorder bindRecording(const Recording& recording, const RenderPipelines::State& pipelines,
                           const PassPipelines& passes) {
  const DeviceTable& vk = recording.view.device.table;
  const VkDescriptorSet set = recording.view.images->update(recording.number, recording.info);
  vk.vkCmdBindDescriptorSets(recording.commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines.layout, 0, 1,
                             &set, 0, nullptr);
  return {.vk = vk,
          .commandBuffer = recording.commandBuffer,
          .layout = pipelines.layout,
          .pipelines = passes,
          .frame = recording.blockAddress(),
          .counters = recording.view.buffers[ViewBuffer::kCounters].buffer,
          .countersOffset = recording.countersOffset()};
}

void endRecording(const Recording& recording) {
  const ViewBuffers& buffers = recording.view.buffers;
  recording.view.device.table.recordMemoryBarrier(
      recording.commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
      VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
  const VkBufferCopy copy{recording.countersOffset(), recording.number * kBlockStride, sizeof(gpu::Counters)};
  recording.view.device.table.vkCmdCopyBuffer(recording.commandBuffer, buffers[ViewBuffer::kCounters].buffer,
                                              buffers[ViewBuffer::kReadback].buffer, 1, &copy);
  recording.view.device.table.recordMemoryBarrier(
      recording.commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  recording.view.images->leave(recording.commandBuffer, recording.info);
}

const gpu::Counters& readCounters(const ViewState& view, uint32_t number) {
  const char* readback = static_cast<const char*>(view.buffers[ViewBuffer::kReadback].mapped);
  return *reinterpret_cast<const gpu::Counters*>(readback + number * kBlockStride);
}

void recordCull(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  if (lensClassOf(recording.info.camera) == gpu::kLensClassMapped) recordRays(recording, recorder);
  const uint32_t groups = groupsPerChunk(asset);
  const auto chunks = static_cast<uint32_t>(asset.chunks.size());
  recorder.run(Pass::kCullCells, groups, chunks);
  recorder.wait();
  recorder.run(Pass::kCompactCells, groups, chunks);
  recorder.wait();
}

void recordExpand(const PassRecorder& recorder) {
  recorder.runIndirect(Pass::kExpandCells, offsetof(gpu::Counters, expandDispatch));
}

void recordShade(const PassRecorder& recorder) {
  recorder.runIndirect(Pass::kShadeSites, offsetof(gpu::Counters, siteDispatch));
}

Pass pixelPass(Pass plain, const FrothRenderInfo& info) {
  const uint32_t form = (isWideColour(info) ? 1 : 0) + (isFullFrame(info) ? 2 : 0);
  return static_cast<Pass>(static_cast<uint32_t>(plain) + form);
}

void recordPixels(const Recording& recording, const PassRecorder& recorder, Pass pass) {
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  recorder.run(pass, groupsOver(extent.width, gpu::kSubTileSize), groupsOver(extent.height, gpu::kSubTileSize));
}

}  // namespace froth
