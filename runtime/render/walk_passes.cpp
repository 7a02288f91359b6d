#include "runtime/render/view_state.h"

namespace froth {

void recordWalkPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  recordCull(recorder, asset);
  recording.mark("cull");
  recordShade(recorder);
  recording.mark("shade");
  recorder.run(Pass::kLocate, 1);
  recorder.wait();
  recording.mark("locate");
  recordPixels(recording, recorder, isWideColour(recording.info) ? Pass::kWalk32 : Pass::kWalk16);
  recording.mark("walk");
}

}  // namespace froth
