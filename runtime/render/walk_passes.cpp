#include "runtime/render/view_state.h"

namespace froth {
namespace {

void recordNearest(const Recording& recording) {
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.runIndirect(Pass::kNearestBalls, offsetof(gpu::Counters, tileDispatch));
  }
}

void recordLocate(const Recording& recording) {
  const VkExtent2D& extent = recording.info.camera.scissor.extent;
  for (const RecordingPart& part : recording.parts()) {
    part.recorder.run(Pass::kLocate, tilesAlong(extent.width), tilesAlong(extent.height));
  }
}

}  // namespace

void recordWalkPasses(const Recording& recording) {
  recording.run("cull", [&] { recordCull(recording); });
  recording.run("shade", [&] {
    recordNearest(recording);
    recording.wait();
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
