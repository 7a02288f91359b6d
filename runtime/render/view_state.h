// What a view keeps between frames, and one recording of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/render/frame_block.h"
#include "runtime/render/image_pass.h"
#include "runtime/render/output_images.h"
#include "runtime/render/pass_recorder.h"
#include "runtime/render/pass_timer.h"
#include "runtime/render/view_buffers.h"
#include "runtime/render/view_renderer.h"

namespace froth {

// What was recorded in one of the frames in flight.
struct FrameSlot {
  uint64_t serial = 0;  // 0: nothing
  uint32_t recordings = 0;
};

// Growth that the budget refused. It is not tried again in every frame, only for another asset or budget, or once the context
// holds less.
struct GrowthRefusal {
  const GpuAsset* asset;
  VkDeviceSize budget;
  VkDeviceSize deviceBytes;  // that the context held
  Error error;
};

struct ViewState {
  Device& device;
  ViewBuffers buffers;
  std::unique_ptr<OutputImages> images;
  std::unique_ptr<ImageSets> hitSets{};    // two per recording; null: the view keeps no hits
  std::unique_ptr<PassTimer> timer;     // null: not measured
  std::vector<FrameSlot> slots;         // [frames in flight]
  uint32_t slot = 0;                    // of the frame being recorded
  uint64_t lastSerial = 0;              // newest recorded frame
  const GpuAsset* walkAsset = nullptr;  // whose cell kWalkStart holds
  FrothViewStatus status{};  // of the newest complete frame
  ViewDemand demand{};       // of that frame
  std::optional<GrowthRefusal> refusal{};
};

enum class RecordingKind { kRaster, kWalk, kClear };

// From the first barrier to the last of one raster, walk or clear.
struct Recording {
  ViewState& view;
  const FrothRenderInfo& info;
  VkCommandBuffer commandBuffer;
  RecordingKind kind;
  uint32_t place;   // within the frame: device block, counters
  uint32_t number;  // among all recordings in flight: descriptor set, staging, read-back

  VkDeviceAddress blockAddress() const;
  VkDeviceAddress countersAddress() const;
  VkDeviceSize countersOffset() const;  // in kCounters
  void mark(const char* pass) const;    // the passes since the last mark are timed under this name
};

// Enters the images, uploads the frame's block, clears the counters. instance: null for a clear.
Recording beginRecording(ViewState& view, VkCommandBuffer commandBuffer, RecordingKind kind,
                         const FrothRenderInfo& info, uint64_t serial, const RenderInstance* instance);

// Binds the images; the passes can be recorded.
PassRecorder bindRecording(const Recording& recording, const RenderPipelines::State& pipelines,
                           const PassPipelines& passes);

// Copies the counters to the host, leaves the images.
void endRecording(const Recording& recording);

// Counters of a recording that the GPU has completed.
const gpu::Counters& readCounters(const ViewState& view, uint32_t number);

// Cull, list and count the visible cells, for a mapped lens once its rays are known; shared by raster and walk.
void recordCull(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset);
// Expand the listed cells; shade their detail sites. Neither needs the other.
void recordExpand(const PassRecorder& recorder);
void recordShade(const PassRecorder& recorder);

void recordRasterPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset);
void recordWalkPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset);

// The pass that writes the wanted images, of a raster or a walk; `plain`: its form for rgba16f without normals, followed by
// its others.
Pass pixelPass(Pass plain, const FrothRenderInfo& info);
// A workgroup per kSubTileSize x kSubTileSize pixels.
void recordPixels(const Recording& recording, const PassRecorder& recorder, Pass pass);

}  // namespace froth
