// What a view keeps between frames, and one recording of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/render/breadcrumbs.h"
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

// Growth that the budget refused. It is not tried again in every frame, only for another asset or budget, once less is
// wanted, or once the context holds less.
struct GrowthRefusal {
  const GpuAsset* asset;
  ViewCapacity wanted;
  VkDeviceSize budget;
  VkDeviceSize deviceBytes;  // that the context held
  Error error;
};

// The transients of one instance in a view.
struct InstanceSpace {
  InstanceSpace(Device& device, uint32_t recordings) : buffers(device), serials(recordings) {}

  ViewBuffers buffers;
  std::vector<uint64_t> serials;        // [recordings in flight] the frame of what each holds; 0: nothing
  FrothInstance instance{};             // whose it was in the newest prepare()
  bool isTaken = false;                 // by an instance, in the newest prepare()
  uint64_t lastSerial = 0;              // newest frame recorded with it
  const GpuAsset* walkAsset = nullptr;  // whose cells kWalkStart holds
  ViewDemand demand{};                  // of the newest complete frame
  std::optional<GrowthRefusal> refusal{};
};

// One instance of a recording.
struct RecordingPart {
  InstanceSpace& space;
  const GpuAsset* asset;  // null: a clear
  uint32_t overlaps;      // PartOrder
  uint32_t groups;        // FrameBlock::groupCount
  PassRecorder recorder;
};

struct ViewState {
  Device& device;
  std::vector<std::unique_ptr<InstanceSpace>> spaces;  // the first stays
  std::unique_ptr<OutputImages> images;
  std::unique_ptr<DescriptorSets> hitSets{};  // kHitImages per recording; null: the view keeps no hits
  // one per frame in flight; null: the context does not do that
  std::unique_ptr<DescriptorSets> compositeSets{}, exportSets{};
  std::unique_ptr<PassTimer> timer;    // null: not measured
  Breadcrumbs* breadcrumbs = nullptr;  // the context's; null: none are wanted
  std::vector<FrameSlot> slots;        // [frames in flight]
  ViewCapacity leastCapacity{};        // of every space
  uint32_t reservedCells = 0;          // of an instance, at most: coverAsset
  uint32_t slot = 0;                   // of the frame being recorded
  uint64_t lastSerial = 0;             // newest recorded frame
  FrothViewStatus status{};            // of the newest complete frame
  std::vector<RecordingPart> parts{};  // of the recording under way; has room for gpu::kMostInstances
};

// From the first barrier to the last of one raster or walk, or of a clear where there is nothing to draw.
struct Recording {
  ViewState& view;
  const RenderPipelines::State& pipelines;
  const FrothRenderInfo& info;
  VkCommandBuffer commandBuffer;
  RenderMethod method;
  uint32_t place;   // within the frame: device block, counters
  uint32_t number;  // among all recordings in flight: descriptor set, staging, read-back

  std::span<const RecordingPart> parts() const { return view.parts; }
  VkDeviceSize countersOffset() const;  // in kCounters
  // Passes that are timed, and stand in captures and breadcrumbs, under this name.
  template <class Passes>
  void run(const char* name, const Passes& passes) const {
    begin(name);
    recordPass(view.breadcrumbs, commandBuffer, {callOf(method), name, info.eye, view.lastSerial}, passes);
    end(name);
  }
  void wait() const;  // later passes see what earlier ones wrote

 private:
  void begin(const char* name) const;
  void end(const char* name) const;
};

// Enters the images.
Recording beginRecording(ViewState& view, const RenderPipelines::State& pipelines, VkCommandBuffer commandBuffer,
                         RenderMethod method, const FrothRenderInfo& info, uint64_t serial);

// Uploads the block of an instance in its space and clears the counters. instance: null for a clear. Parts are added in
// the order of PartOrder.
void addPart(const Recording& recording, InstanceSpace& space, const RenderInstance* instance,
             const PassPipelines& passes, uint32_t overlaps = 0);

// Once all parts are there: binds the images; the passes can be recorded.
void startPasses(const Recording& recording);

// Copies the counters to the host, leaves the images.
void endRecording(const Recording& recording);

// Counters of a recording that the GPU has completed.
const gpu::Counters& readCounters(const InstanceSpace& space, uint32_t number);

// Cull, list and count the visible cells, for a mapped lens once its rays are known; shared by raster and walk.
void recordCull(const Recording& recording);
// Expand the listed cells; shade their detail sites. Neither needs the other.
void recordExpand(const Recording& recording);
void recordShade(const Recording& recording);

void recordRasterPasses(const Recording& recording);
void recordWalkPasses(const Recording& recording);

// The pass that writes the wanted images, of a raster or a walk; `plain`: its form for rgba16f without normals,
// followed by its others.
Pass pixelPass(Pass plain, const FrothRenderInfo& info);
// Tells the passes that write images of all parts.
void pushParts(const Recording& recording);
// The first part's, for passes that draw several too.
PassRecorder recorderOf(const Recording& recording, Pass pass);
// A workgroup per kSubTileSize x kSubTileSize pixels.
void recordPixels(const Recording& recording, Pass pass);

}  // namespace froth
