// How every recording begins and ends, and the passes that raster and walk share.
#include <cstddef>
#include <cstring>

#include "runtime/render/camera_rays.h"
#include "runtime/render/frame_images.h"
#include "runtime/render/hit_passes.h"
#include "runtime/render/view_state.h"

namespace froth {
namespace {

void writeBlock(const Recording& recording, RecordingPart& part, const RenderInstance* instance) {
  const ViewBuffers& buffers = part.space.buffers;
  char* staged =
      static_cast<char*>(buffers[ViewBuffer::kStaging].mapped) + recording.number * buffers.recordingStride();
  gpu::FrameBlock block{};
  if (!instance) {
    fillOutputs(recording.info, block);
  } else {
    const VkDeviceAddress counters = buffers[ViewBuffer::kCounters].address + recording.countersOffset();
    fillFrame(recording.method, recording.info, *instance, buffers, {part.recorder.frame, counters}, block,
              reinterpret_cast<gpu::ChunkEntry*>(staged + kBlockStride));
    block.overlaps = part.overlaps;
    part.groups = block.groupCount;
  }
  const auto index = static_cast<uint32_t>(recording.parts().size() - 1);
  describeHits(recording, index, block);
  std::memcpy(staged, &block, sizeof(block));
  writeHits(recording, index, instance);
}

// Copies the block to the device and clears what the passes count in or only partly write.
void recordUpload(const Recording& recording, const RecordingPart& part) {
  InstanceSpace& space = part.space;
  const DeviceTable& vk = recording.view.device.table;
  const VkDeviceSize stride = space.buffers.recordingStride();
  const VkBufferCopy copy{recording.number * stride, recording.place * stride, stride};
  vk.vkCmdCopyBuffer(recording.commandBuffer, space.buffers[ViewBuffer::kStaging].buffer,
                     space.buffers[ViewBuffer::kFrames].buffer, 1, &copy);
  vk.vkCmdFillBuffer(recording.commandBuffer, space.buffers[ViewBuffer::kCounters].buffer, recording.countersOffset(),
                     sizeof(gpu::Counters), 0);
  if (!part.asset) return;
  const TallyLayout tallies = space.buffers.tallies();
  const bool isWalk = recording.method == RenderMethod::kWalk;
  const uint64_t first = isWalk ? tallies.tileLengths : 0;
  const uint64_t end = isWalk ? tallies.tileSums : tallies.end;
  vk.vkCmdFillBuffer(recording.commandBuffer, space.buffers[ViewBuffer::kTallies].buffer, first, end - first, 0);
  if (isWalk && space.walkAsset != part.asset) {
    vk.vkCmdFillBuffer(recording.commandBuffer, space.buffers[ViewBuffer::kWalkStart].buffer, 0, VK_WHOLE_SIZE, 0);
    space.walkAsset = part.asset;
  }
}

// Of instances whose cells may not all have room.
void recordChoice(const Recording& recording) {
  const auto forShort = [&](const auto& record) {
    bool isAny = false;
    for (const RecordingPart& part : recording.parts()) {
      if (holdsAllCells(*part.asset, part.space.buffers.capacity())) continue;
      record(part.recorder);
      isAny = true;
    }
    if (isAny) recording.wait();
  };
  forShort([](const PassRecorder& recorder) { recorder.run(Pass::kChooseCells, 1); });
  forShort([](const PassRecorder& recorder) {
    recorder.runIndirect(Pass::kCullCells, offsetof(gpu::Counters, dropDispatch));
  });
}

void recordRayPasses(const Recording& recording) {
  const FrothCamera& camera = recording.info.camera;
  const uint32_t tilesX = tilesAlong(camera.scissor.extent.width), tilesY = tilesAlong(camera.scissor.extent.height);
  const bool isByImage = camera.lens.kind == FROTH_LENS_RAY_MAP;
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.run(isByImage ? Pass::kAimRaysByImage : Pass::kAimRays, tilesX, tilesY);
  }
  recording.wait();
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.run(Pass::kWidenCones, groupsOver(tilesX, gpu::kBlockTiles), groupsOver(tilesY, gpu::kBlockTiles));
  }
  recording.wait();
}

}  // namespace

VkDeviceSize Recording::countersOffset() const { return place * kBlockStride; }

void Recording::begin(const char* name) const { view.device.table.beginLabel(commandBuffer, name); }

void Recording::end(const char* name) const {
  if (view.timer) view.timer->mark(commandBuffer, number, name);
  view.device.table.endLabel(commandBuffer);
}

void Recording::wait() const { view.parts.front().recorder.wait(); }

Recording beginRecording(ViewState& view, const RenderPipelines::State& pipelines, VkCommandBuffer commandBuffer,
                         RenderMethod method, const FrothRenderInfo& info, uint64_t serial) {
  FrameSlot& slot = view.slots[view.slot];
  const uint32_t place = slot.recordings % view.leastCapacity.recordings;
  const Recording recording{.view = view,
                            .pipelines = pipelines,
                            .info = info,
                            .commandBuffer = commandBuffer,
                            .method = method,
                            .place = place,
                            .number = view.slot * view.leastCapacity.recordings + place};
  slot.serial = serial;
  slot.recordings = place + 1;
  view.lastSerial = serial;
  view.parts.clear();
  view.device.table.beginLabel(commandBuffer, method == RenderMethod::kRaster ? "froth raster" : "froth walk");
  view.images->enter(commandBuffer, info);
  if (view.timer) view.timer->begin(commandBuffer, recording.number);
  return recording;
}

void addPart(const Recording& recording, InstanceSpace& space, const RenderInstance* instance,
             const PassPipelines& passes, uint32_t overlaps) {
  space.serials[recording.number] = space.lastSerial = recording.view.lastSerial;
  const VkDeviceAddress block =
      space.buffers[ViewBuffer::kFrames].address + recording.place * space.buffers.recordingStride();
  recording.view.parts.push_back({.space = space,
                                  .asset = instance ? instance->asset : nullptr,
                                  .overlaps = overlaps,
                                  .groups = 0,
                                  .recorder = {.vk = recording.view.device.table,
                                               .commandBuffer = recording.commandBuffer,
                                               .layout = recording.pipelines.layout,
                                               .pipelines = &passes,
                                               .frame = block,
                                               .counters = space.buffers[ViewBuffer::kCounters].buffer,
                                               .countersOffset = recording.countersOffset()}});
  writeBlock(recording, recording.view.parts.back(), instance);
  recordUpload(recording, recording.view.parts.back());
}

void startPasses(const Recording& recording) {
  const DeviceTable& vk = recording.view.device.table;
  vk.recordMemoryBarrier(recording.commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  const VkDescriptorSet set = recording.view.images->update(recording.number, recording.info);
  vk.vkCmdBindDescriptorSets(recording.commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, recording.pipelines.layout, 0, 1,
                             &set, 0, nullptr);
}

void endRecording(const Recording& recording) {
  const DeviceTable& vk = recording.view.device.table;
  vk.recordMemoryBarrier(recording.commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                         VK_ACCESS_2_TRANSFER_READ_BIT);
  const VkBufferCopy copy{recording.countersOffset(), recording.number * kBlockStride, sizeof(gpu::Counters)};
  for (const RecordingPart& part : recording.parts()) {
    const ViewBuffers& buffers = part.space.buffers;
    vk.vkCmdCopyBuffer(recording.commandBuffer, buffers[ViewBuffer::kCounters].buffer,
                       buffers[ViewBuffer::kReadback].buffer, 1, &copy);
  }
  vk.recordMemoryBarrier(recording.commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  recording.view.images->leave(recording.commandBuffer, recording.info);
  vk.endLabel(recording.commandBuffer);
}

const gpu::Counters& readCounters(const InstanceSpace& space, uint32_t number) {
  const char* readback = static_cast<const char*>(space.buffers[ViewBuffer::kReadback].mapped);
  return *reinterpret_cast<const gpu::Counters*>(readback + number * kBlockStride);
}

void recordCull(const Recording& recording) {
  if (lensClassOf(recording.info.camera) == gpu::kLensClassMapped) {
    recording.run("aim", [&] { recordRayPasses(recording); });
  }
  const auto runOverCells = [&](Pass pass) {
    for (const RecordingPart& part : recording.parts()) part.recorder.runOver(pass, part.groups);
    recording.wait();
  };
  runOverCells(Pass::kCullCells);
  recordChoice(recording);
  runOverCells(Pass::kCompactCells);
}

void recordExpand(const Recording& recording) {
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.runIndirect(Pass::kExpandCells, offsetof(gpu::Counters, expandDispatch));
  }
}

void recordShade(const Recording& recording) {
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.runIndirect(Pass::kShadeDetails, offsetof(gpu::Counters, detailDispatch));
  }
}

Pass pixelPass(Pass plain, const FrothRenderInfo& info) {
  const uint32_t form = (isWideColour(info) ? 1 : 0) + (isFullFrame(info) ? 2 : 0);
  return static_cast<Pass>(static_cast<uint32_t>(plain) + form);
}

void pushParts(const Recording& recording) {
  gpu::PartConstants constants{};
  for (const RecordingPart& part : recording.parts()) constants.parts[constants.partCount++] = part.recorder.frame;
  recording.view.device.table.vkCmdPushConstants(recording.commandBuffer, recording.pipelines.layout,
                                                 VK_SHADER_STAGE_COMPUTE_BIT, sizeof(gpu::PassConstants),
                                                 sizeof(constants), &constants);
}

PassRecorder recorderOf(const Recording& recording, Pass pass) {
  PassRecorder recorder = recording.parts().front().recorder;
  const auto index = static_cast<uint32_t>(pass);
  if (index >= kFirstMergedPass && index < kFirstShapedPass) {
    recorder.pipelines = &recording.pipelines.merged[lensClassOf(recording.info.camera)];
  }
  return recorder;
}

void recordPixels(const Recording& recording, Pass pass) {
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  recorderOf(recording, pass)
      .run(pass, groupsOver(extent.width, gpu::kSubTileSize), groupsOver(extent.height, gpu::kSubTileSize));
}

}  // namespace froth
