// A fade from one cut to the next: two recordings of a view in a frame. The first draws the cut before, and keeps its
// colours in ViewBuffer::kFade; the second draws the cut now, and mixes them in.
#pragma once

#include "froth/froth.h"
#include "runtime/render/view_state.h"

namespace froth {

// The image of the first recording is the second's colour. Of all others only those that are read.
struct FadeInfos {
  FrothRenderInfo before, now;
};
FadeInfos splitForFade(const FrothRenderInfo& info);

// After the pass that writes colours. weight [0..1): of these; 0: they are kept. All kept pixels are those of the
// newest recording that kept some, of the same region.
void recordFade(const Recording& recording, float weight);

}  // namespace froth
