#include "runtime/render/camera_rays.h"
#include "runtime/render/view_state.h"

namespace froth {

void recordWalkPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  recordCull(recording, recorder, asset);
  recording.mark("cull");
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  const bool isPerTile = lensClassOf(recording.info.camera) == gpu::kLensClassOrthographic;
  recorder.run(Pass::kLocate, isPerTile ? tilesAlong(extent.width) : 1,
               isPerTile ? tilesAlong(extent.height) : 1);  // needs nothing of the passes around it, so it runs beside them
  recordExpand(recorder);
  recordShade(recorder);
  recorder.wait();
  recording.mark("shade");
  recordPixels(recording, recorder, pixelPass(Pass::kWalk16, recording.info));
  recording.mark("walk");
}

}  // namespace froth
