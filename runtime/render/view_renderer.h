// Records the passes of one view: cull -> sort -> bin -> shade -> raster, or cull -> nearest -> locate, shade -> walk.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "froth/froth_composite.h"
#include "runtime/asset/gpu_asset.h"
#include "runtime/device/device.h"
#include "runtime/render/view_capacity.h"

namespace froth {

class Breadcrumbs;      // breadcrumbs.h
struct ViewState;       // view_state.h
class RenderPipelines;  // runtime/render/pipelines.h: layouts and pipelines, made once per context and per
                        // asset shape

enum class RenderMethod { kRaster, kWalk };
constexpr const char* callOf(RenderMethod method) {
  return method == RenderMethod::kRaster ? "frothRecordRaster" : "frothRecordWalk";
}
inline constexpr uint32_t kMostEyes = 2;

// One instance as the passes see it.
struct RenderInstance {
  FrothInstance handle{};
  const GpuAsset* asset = nullptr;
  std::array<double, 3> position{};
  std::array<float, 4> rotation{0, 0, 0, 1};  // unit quaternion (x, y, z, w), world from asset
  float scale = 1;
  float nearRatio = 0, nearDepth = 0;  // FrothRenderInfo's, resolved; 0: off
  uint32_t userId = 0;
  float exposure = 1;
  const RenderInstance* previous = nullptr;  // where it stood in the frame before; null: here
};

struct ViewOptions {
  VkExtent2D maxExtent{};
  uint32_t lensClasses = 0;  // FrothLensClass bits of its cameras
  uint32_t framesInFlight = 1;
  bool measurePasses = false;
  bool keepsHits = false;      // for id and motion
  bool keepsReactive = false;  // for reactive, with hits
  bool fades = false;          // from a cut to the next
  bool composites = false, exportsDepth = false;
  Breadcrumbs* breadcrumbs = nullptr;    // they stay longer than the renderer; null: none are wanted
  uint32_t reservedCells = 0;            // room from the first frame on, for each instance; no more than its asset has
  const GpuAsset* firstAsset = nullptr;  // of the first instance: room for it is made at once, if the budget has it
};

// What a view has room for, for each instance, before an asset is known.
ViewCapacity leastCapacity(const ViewOptions& options);
// The same for the first instance, which has the hits of all.
ViewCapacity firstCapacity(const ViewOptions& options);

// What an instance with levels of detail takes of a view.
struct CutRoom {
  VkDeviceSize fixedBytes = 0, bytesPerCell = 0;  // [bytes] whatever its cut is; for each cell of the cut
  uint32_t mostCells = 0;                         // so many cells of a cut at most have room ahead of a frame
  VkDeviceSize heldBytes = 0;                     // [bytes] now
};

class ViewRenderer {
 public:
  // Allocates transients for the maximum extent; they grow in prepare() only.
  static Result<std::unique_ptr<ViewRenderer>> create(Device& device, const ViewOptions& options);
  ~ViewRenderer();  // the GPU must be done with the view

  // Starts with what the other view's newest complete frame wanted of its instances. Pairs go with the area.
  void startLike(const ViewRenderer& other);

  // In frothUpdate: reads back the counts and times of completed frames; grows buffers for `instances` (of which only
  // handle and asset count; at most gpu::kMostInstances) and for the overflows seen; replaced buffers are freed once
  // `completedSerial` has passed their last use. On an error the buffers are as before, or hold what the budget has
  // room for; recording goes on with those instances that they cover.
  Status prepare(uint64_t completedSerial, std::span<const RenderInstance> instances);

  // Whether an instance that can be drawn still can with the next chunks of its asset, and lacks no cells then, unless
  // the budget refused the room.
  bool coversNext(const RenderInstance& instance) const;

  // Whether the view has the buffers to draw the asset of the instance, with room for some of its cells at least.
  bool covers(const RenderInstance& instance) const;

  // For sharing a budget between views and chunks.
  CutRoom roomForCuts(FrothInstance instance, const GpuAsset& asset) const;
  VkDeviceSize heldBytes() const;  // [bytes] of device memory, for all instances

  // [bytes] of buffers for what the newest complete frame wanted of the instance, were there so many detail sites per
  // cell; 0: they are there.
  VkDeviceSize missingBytes(const RenderInstance& instance, uint32_t detailCount) const;

  // For a lowered budget. prepare() does the work, over several frames; until it is done isShrinking().
  VkDeviceSize shrinkableBytes() const;  // [bytes] of device memory that shrink(0) gives back
  void shrink(double factor);            // keeps `factor` [0..1] of them
  bool isShrinking() const;

  // Between frothUpdate calls, once per frame and method, and with each of two cuts; `serial` is that of the frame.
  // `instances`: all that are to be seen; none clears the wanted outputs (colour 0, distance +inf, normal 0). info has
  // been checked and its defaults resolved: camera.scissor is what is drawn, not empty, within maxExtent and the
  // images. Allocates nothing. Returns the FrothViewBit set known at record time. fadeWeight: fade.h; of a view that
  // fades. 1: the instances alone.
  uint32_t record(RenderMethod method, VkCommandBuffer commandBuffer, RenderPipelines& pipelines,
                  std::span<const RenderInstance> instances, const FrothRenderInfo& info, uint64_t serial,
                  float fadeWeight);

  // Into the engine's images; after record() and once per frame. info has been checked. region: what was drawn.
  void composite(VkCommandBuffer commandBuffer, RenderPipelines& pipelines, const FrothCompositeInfo& info,
                 const VkRect2D& region);
  void exportDepth(VkCommandBuffer commandBuffer, RenderPipelines& pipelines, const FrothDepthExportInfo& info,
                   const VkRect2D& region, bool isReversed);

  // The frame with this serial was recorded and will never be submitted: its counts are not read, its place
  // is free.
  void dropFrame(uint64_t serial);

  const FrothViewStatus& status() const;  // of the newest complete frame

 private:
  ViewRenderer();
  std::unique_ptr<ViewState> state_;
};

}  // namespace froth
