/* Froth, streaming: what is wanted of assets with levels of detail, how far it is, and which chunks are drawn.
 *
 * An asset baked with levels is READY when its floor, its coarsest form, is resident; the floor stays until the asset
 * is closed. Finer chunks come and go by what views see: the newest camera of each view, and stream points. Groups of
 * cells are refined in the order of how well their error is seen, what cameras look at before what is around them,
 * until an error is smaller than a pixel or the budget (FrothContextInfo::deviceBudget, frothSetBudget) has no room. So
 * what is wanted depends on views, points and budget alone; while it comes, what is resident is drawn, and there is
 * never a hole. Assets without levels are not touched.
 *
 * Fades: with FrothViewInfo::fadeFrames = n the n frames from a change of cuts on draw both cuts and mix colour and
 * alpha: frame i has i / (n + 1) of the new one. All other images are those of the new cut. Such a frame takes about
 * twice the time. Cuts belong to assets: while a view fades, no cut of the context changes again, views without
 * fadeFrames draw the new ones at once, and chunks that leave stay, unless their room is needed: then the fade ends.
 * Frames are counted by frothUpdate. The first picture of an asset does not fade.
 *
 * Threads: as all calls that take a context (froth.h): one at a time. */
#ifndef FROTH_FROTH_STREAM_H
#define FROTH_FROTH_STREAM_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A place from where something will be seen soon: the end of a cut scene, a door. It counts as a view that sees all
 * around does. */
typedef struct FrothStreamPoint {
  double position[3]; /* in the world */
  double radius;      /* [>= 0] the eye may be anywhere this near to the position */
  float pixelAngle;   /* [radians, > 0] of a pixel: 2 tan(fov / 2) / width */
  float detail;       /* [>= 0] as FrothStreamInfo::detail; 0: 1 */
} FrothStreamPoint;

typedef struct FrothStreamInfo {
  uint32_t structSize;
  float detail;       /* [>= 0] of views: errors may be 1 / detail pixels large. 0: 1 */
  uint64_t mostCells; /* live cells that the wanted chunks of all assets have at most, but for floors; 0: no limit */
  uint32_t pointCount;
  const FrothStreamPoint* points; /* [pointCount] copied */
  /* 1: each asset wants what views and points wanted of it, by their detail, in the newest frothUpdate before; so one
   * can look at its chunks from elsewhere. Budget and mostCells go on counting. An asset that is new wants its floor */
  uint32_t isFrozen;
} FrothStreamInfo;

/* From the next frothUpdate on. FROTH_ERROR_ARGUMENT: nothing changes. */
FROTH_API FrothResult frothSetStreaming(FrothContext* context, const FrothStreamInfo* info);

/* Of all assets with levels, as of the newest frothUpdate. */
typedef struct FrothStreamStatus {
  uint32_t structSize;
  uint32_t isSettled;      /* 1: what is wanted is drawn, unfaded: a picture at rest changes no more */
  uint32_t drawnChunks;    /* by the next recording, once views have room for them */
  uint32_t residentChunks; /* drawn or kept */
  uint32_t comingChunks;   /* read, decoded or uploaded */
  uint32_t failedChunks;   /* for good: other levels stand for them */
  uint64_t usedBytes;      /* [bytes] of device memory, by estimate before a chunk was resident: of those that are
                              resident, on the way, or leave */
  uint64_t budgetBytes;    /* what chunks may take: their share of the budget that nothing else of the context holds,
                              the rest is for what views need of their cells. 0: there is no budget */
  uint64_t excessBytes;    /* of usedBytes above budgetBytes, since the budget was lowered */
  uint32_t oldestRequest;  /* [frames] for so long a chunk that is needed has been waited for */
  uint32_t floorHits;      /* chunks of floors that are drawn where finer ones are wanted */
  uint64_t evictions, retries, failures; /* since the context was created, or its device restored */
} FrothStreamStatus;

FROTH_API FrothResult frothGetStreamStatus(FrothContext* context, FrothStreamStatus* status);

typedef enum FrothChunkState {
  FROTH_CHUNK_ABSENT = 0,
  FROTH_CHUNK_COMING = 1,   /* waits for its read, is read, decoded or uploaded */
  FROTH_CHUNK_RESIDENT = 2, /* on the device and not drawn; also while frames in flight or a fade may still draw it */
  FROTH_CHUNK_DRAWN = 3,    /* by all views that show the asset, from this frame on */
  FROTH_CHUNK_FAILED = 4,   /* to be brought; may be tried again (FrothStreamStatus::failedChunks: for good) */
  FROTH_CHUNK_STATE_MAX = 0x7fffffff
} FrothChunkState;

/* A chunk of an asset. It suits pixels whose size is between `error` and `coarserError`: with smaller ones its own
 * error is seen, with larger ones a coarser chunk does. */
typedef struct FrothChunk {
  double centre[3];      /* of a ball around the balls of its live cells [asset units] */
  double radius;         /* [asset units] 0: it has no live cells */
  double error;          /* of the group that made it [asset units]; 0: level 0 */
  double coarserError;   /* of the group that it is in [asset units]; +inf: it belongs to the floor */
  uint64_t deviceBytes;  /* that it takes while it is resident; an estimate before it was */
  uint32_t level;        /* 0: the finest */
  uint32_t liveCount;    /* cells that can be seen */
  FrothChunkState state; /* as of the newest frothUpdate */
} FrothChunk;

/* Copies at most `capacity` chunks, in the order of the file: chunks[i] has the cells with code >> cellBits == i
 * (FrothAssetStatus::cellBits). *count: the number that the file has, of all levels; 0: its head is not read yet.
 * capacity 0: chunks may be null. An asset without levels has chunks of level 0, which are all drawn once it is READY.
 * For tools and debug views: it looks at each chunk. */
FROTH_API FrothResult frothGetChunks(FrothContext* context, FrothAsset asset, uint32_t capacity, FrothChunk* chunks,
                                     uint32_t* count);

#ifdef __cplusplus
}
#endif
#endif
