#include "runtime/render/view_state.h"

namespace froth {

void recordWalkPasses(const Recording& recording, const PassRecorder& recorder, const GpuAsset& asset) {
  recordCull(recorder, asset);
  recording.mark("cull");
  recorder.run(Pass::kLocate, 1);  // needs nothing of the passes around it, so it runs beside them
  recordExpand(recorder);
  recordShade(recorder);
  recorder.wait();
  recording.mark("shade");
  recordPixels(recording, recorder, pixelPass(Pass::kWalk16, recording.info));
  recording.mark("walk");
}

}  // namespace froth
