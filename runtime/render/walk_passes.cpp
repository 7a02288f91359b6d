#include "runtime/render/camera_rays.h"
#include "runtime/render/view_state.h"

namespace froth {
namespace {

// Needs nothing of the passes around it, so it runs beside them.
void recordLocate(const Recording& recording) {
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  const bool isPerTile = lensClassOf(recording.info.camera) == gpu::kLensClassOrthographic;
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.run(Pass::kLocate, isPerTile ? tilesAlong(extent.width) : 1,
                      isPerTile ? tilesAlong(extent.height) : 1);
  }
}

}  // namespace

void recordWalkPasses(const Recording& recording) {
  recording.run("cull", [&] { recordCull(recording); });
  recording.run("shade", [&] {
    recordLocate(recording);
    recordExpand(recording);
    recordShade(recording);
    recording.wait();
  });
  recording.run("walk", [&] {
    pushParts(recording);
    const bool isMerged = recording.parts().size() > 1;
    recordPixels(recording, pixelPass(isMerged ? Pass::kWalkMerged16 : Pass::kWalk16, recording.info));
  });
}

}  // namespace froth
