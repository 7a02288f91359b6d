// Draws views through the runtime's public API on a Vulkan device, and reads images and measures back.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "baker/input/foam_input.h"
#include "base/result.h"
#include "froth/froth.h"
#include "froth/froth_walk.h"
#include "host/host.h"
#include "host/method.h"
#include "reference/camera/camera.h"
#include "reference/render/reference.h"

namespace froth {

struct GpuDeviceOptions {
  std::string device;         // index or part of a name; empty: the first suitable one
  bool validate = false;      // validation layers; any message fails a render
  bool checkIndices = false;  // shaders check every index; one out of range fails a render
  bool floatColours = false;  // colours of detail sites are floats between passes, where they are halves
  bool measurePasses = false;
  bool countWork = false;    // FrothViewStatus::work; slower
  uint32_t lensClasses = 0;  // FrothLensClass bits of the views that will be drawn (gpu_camera.h)
  bool keepsHits = false;    // views have what ids and motion need
  bool castsRays = false;    // castRays(), queryRays() and timeRays() may be called
  FrothRayPreparation prepareRays = FROTH_PREPARE_NOTHING;  // of the assets
};

struct GpuRenderOptions {
  Method method = Method::kRaster;
  float cutoff = 1e-3f;                                // 0: a ray never ends early
  bool isLinear = false;                               // colour decoded to linear light
  uint32_t maxSteps = 0;                               // of one walk; 0: the runtime's default
  uint32_t maxEntries = 0;                             // of the list of a tile; the same
  bool isFull = false;                                 // of draw(): distance and normal too, all in float
  bool readsNormal = true;                             // of render(); else the image is empty
  FrothTileForm tileForm = FROTH_TILE_FORM_BY_LENGTH;  // of raster
  glm::vec2 jitter{0};                                 // [pixels] of the camera
  // 1 channel, of the view's size: where the scene ends each ray [world units]; null: nowhere
  const Image* ends = nullptr;
};

struct GpuFrame {
  RenderedImages images;
  FrothViewStatus status{};
};

struct RayOptions {
  uint32_t maxSteps = 0;        // of one ray; 0: the runtime's default
  const Image* ends = nullptr;  // as GpuRenderOptions::ends
};

// A detail at which all cells are drawn.
inline constexpr float kAllCells = std::numeric_limits<float>::max();

// Levels of detail; without effect on assets that have none.
struct GpuStreaming {
  float detail = 1;        // FrothStreamInfo
  uint64_t budget = 0;     // [bytes] frothSetBudget
  uint64_t mostCells = 0;  // FrothStreamInfo
};

struct DrawnChunks {
  uint64_t bytes = 0;      // of device memory that they take
  uint64_t liveCells = 0;  // that can be seen
};

// What the rays of a view's pixels say, each cast by itself and without a cut-off.
struct RayFrame {
  RenderedImages images;  // colour is linear, empty of queries; alpha is 1 - transmittance; no normal
  bool hitStepLimit = false;
};

// Rays that are cast again and again.
struct RayTiming {
  glm::dvec3 eye{0};  // what the rays are relative to
  FrothRayKind kind = FROTH_RAY_TRANSMITTANCE;
  float cutoff = 1e-3f;  // 0: a ray never ends early
  uint32_t frames = 1;
  bool readsHits = false;  // RayTimes::hits
};

struct RayTimes {
  std::vector<double> milliseconds;  // on the device, by frame
  FrothWalkStatus status{};          // of the last frame
  std::vector<FrothGpuHit> hits;
};

// One thread at a time.
class GpuRenderer {
 public:
  static Result<std::unique_ptr<GpuRenderer>> create(const GpuDeviceOptions& options);
  ~GpuRenderer();

  // Opens the asset, in place of the one before, places an instance of it for each of `placements` (whose asset is not
  // read) and waits until it is ready. `asset` is read only now. Without success there is none.
  Status load(const AssetInput& asset, const Progress& progress,
              const std::vector<FrothInstanceInfo>& placements = {{}});

  // All channels in float. Draws again while a limit that grows by itself was hit, or levels of detail are on their
  // way.
  Result<GpuFrame> render(const View& view, const GpuRenderOptions& options);
  // Colour and alpha in half floats, by the shaders that a game's frame has; the other images are empty. Draws again as
  // render().
  Result<GpuFrame> renderColour(const View& view, const GpuRenderOptions& options);
  // What a game draws: half-float colour only, left on the device. The status is of this very frame.
  Result<FrothViewStatus> draw(const View& view, const GpuRenderOptions& options);

  // As an engine casts rays from a buffer (frothRecordRays), and a game on the CPU (frothCastRays). Near limits of the
  // view do not apply.
  Result<RayFrame> castRays(const View& view, const RayOptions& options);
  Result<RayFrame> queryRays(const View& view, const RayOptions& options);
  Result<RayTimes> timeRays(const std::vector<FrothGpuRay>& rays, const RayTiming& timing);

  // From the next frame on, of whatever asset; images wait until what they want is drawn.
  Status setStreaming(const GpuStreaming& streaming);
  Result<DrawnChunks> drawnChunks() const;  // as of the newest frame

  const HostDeviceInfo& device() const;
  FrothAssetStatus assetStatus() const;  // zero without an asset

 private:
  GpuRenderer();
  struct State;
  std::unique_ptr<State> state_;
};

// What the runtime needs to know of a view but the image of a ray map; near limits that the view leaves open become the
// asset's.
FrothRenderInfo renderInfoOf(const View& view, const GpuRenderOptions& options);

}  // namespace froth
