// Who looks at assets with levels of detail, as the decisions on chunks want it (runtime/stream/selection.h).
#pragma once

#include <array>
#include <cstdint>

#include "froth/froth.h"
#include "runtime/asset/gpu_asset.h"
#include "runtime/render/view_renderer.h"
#include "runtime/stream/selection.h"

namespace froth {

// A place in the world from where pixels of some size are seen.
struct SeenFrom {
  std::array<double, 3> position{};
  double radius = 0;      // the eye may be anywhere this near [world units]
  double pixelAngle = 0;  // [radians]
  double pixelSize = 0;   // of parallel rays [world units]
  double detail = 1;
  uint32_t mask = 0;                  // of instances that it shows; 0: all
  std::array<SightPlane, 4> sight{};  // as StreamEye's, in the world
};

// Of the viewport's extent: how far beyond each of its sides a camera sees, so that what it turns to comes in time.
inline constexpr double kSightMargin = 0.125;

// A camera whose fields were checked. Its smallest pixel counts; where a lens does not tell, that of a quarter turn
// over the width of the viewport. A projection sees its viewport and the margin; other lenses see all around.
SeenFrom seenFrom(const FrothRenderInfo& info);

// In the axes and units of an instance's asset. No eye looks nearer than a thousandth of the asset's diagonal.
StreamEye eyeOf(const SeenFrom& from, const RenderInstance& instance, const GpuAsset& asset);

}  // namespace froth
