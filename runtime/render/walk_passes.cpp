#include "runtime/render/camera_rays.h"
#include "runtime/render/view_state.h"

namespace froth {

void recordWalkPasses(const Recording& recording) {
  recordCull(recording);
  recording.mark("cull");
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  const bool isPerTile = lensClassOf(recording.info.camera) == gpu::kLensClassOrthographic;
  // needs nothing of the passes around it, so it runs beside them
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.run(Pass::kLocate, isPerTile ? tilesAlong(extent.width) : 1,
                      isPerTile ? tilesAlong(extent.height) : 1);
  }
  recordExpand(recording);
  recordShade(recording);
  recording.wait();
  recording.mark("shade");
  pushParts(recording);
  const bool isMerged = recording.parts().size() > 1;
  recordPixels(recording, pixelPass(isMerged ? Pass::kWalkMerged16 : Pass::kWalk16, recording.info));
  recording.mark("walk");
}

}  // namespace froth
