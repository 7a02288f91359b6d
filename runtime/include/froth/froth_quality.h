/* Froth, quality by time: how much to draw so that frames take the time you want.
 *
 * A controller without a context: it turns the times of complete frames into the scale of the area and the cut-off to
 * draw with. Pixels buy nearly all of a frame's time; a cut-off of 1e-2 instead of 1e-3 buys about 5 %, at 53 dB.
 *
 *   FrothQuality quality = {.structSize = sizeof quality};                       once; and anew for another maxExtent
 *   frothStepQuality(&info, &times, &quality);                                   each frame, before its record call
 *   camera.viewport = {0, 0, round(quality.scale * width), round(quality.scale * height), 0, 1};
 *   render.cutoff = quality.cutoff;
 *
 * A view takes any area up to its maxExtent and allocates nothing for it. Scale the result up yourself: a temporal
 * upscaler, or a blit.
 *
 * Threads: any, one at a time per FrothQuality. */
#ifndef FROTH_FROTH_QUALITY_H
#define FROTH_FROTH_QUALITY_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothQualityInfo {
  uint32_t structSize;
  float targetMilliseconds;       /* [> 0] no frame should take longer; steady ones take 0.75 to 1 of it */
  float leastScale;               /* [0 < s <= mostScale] of width and height; 0: half of mostScale */
  float mostScale;                /* [<= 1] 0: 1 */
  float cutoff;                   /* [< 1] FrothRenderInfo::cutoff at mostScale; 0: 1e-3; negative: none */
  float reducedCutoff;            /* [< 1] below mostScale; 0: 1e-2; negative: none */
  FrothMessageCallback onMessage; /* may be null; called during the call, on its thread */
  void* messageUser;
} FrothQualityInfo;

typedef struct FrothQualityTimes {
  uint32_t structSize;
  uint64_t serial; /* [> 0, growing] FrothFrame's, of the frame that is recorded next */
  /* FrothViewStatus::serial, of the newest complete frame; 0: none. A frame counts once, by the scale with which it was
   * drawn: so times may come late, by up to 16 frames, and some may be missing */
  uint64_t measuredSerial;
  /* [>= 0, finite] GPU time of that frame: the sum of FrothViewStatus::passes, of all views that follow the scale, and
   * of passes of yours that do. 0: not measured */
  double milliseconds;
} FrothQualityTimes;

/* Zero but for structSize at the start. The caller reads the first two fields and keeps the struct between calls. */
typedef struct FrothQuality {
  uint32_t structSize;
  float scale;  /* of width and height of the area to draw, leastScale to mostScale */
  float cutoff; /* FrothRenderInfo::cutoff to draw with */
  /* of the controller */
  uint32_t drawnCount, measuredCount, steadyCount;
  uint64_t measuredSerial;
  uint64_t drawnSerials[16]; /* by drawnCount, around and around */
  float drawnScales[16];
  double costs[8]; /* [ms] by measuredCount, the same: of a measured frame, had it had scale 1 */
} FrothQuality;

/* Decides what the next frame is drawn with.
 * Down: when the median of the last three measured frames exceeds the target; at once, to 0.9 of the target, to half
 * the area at most. So a jump is answered within the frames in flight and two more, and a single slow frame is not.
 * Up: when of eight measured frames, all of the present scale, seven took less than 0.75 of the target; towards 0.9 of
 * it, by 0.15 of the area at most.
 * FROTH_ERROR_ARGUMENT: *quality is as it was. */
FROTH_API FrothResult frothStepQuality(const FrothQualityInfo* info, const FrothQualityTimes* times,
                                       FrothQuality* quality);

#ifdef __cplusplus
}
#endif
#endif
