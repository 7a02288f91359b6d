/* Froth: a runtime for radiance foams, inside the engine's own Vulkan. Guide: docs/EMBEDDING.md.
 *
 * Needs:  Vulkan 1.3 with bufferDeviceAddress and synchronization2, a queue family with COMPUTE.
 * Does:   records compute work into the caller's command buffers; writes the caller's images.
 * Never:  submits, waits for the GPU in a frame call, owns a queue, creates a window, prints, aborts, keeps globals,
 * but for the allocator of froth_host.h.
 *
 * A frame:  frothUpdate -> frothRecordUpload(cmd) -> frothRecordRaster(cmd) or frothRecordWalk(cmd) per view -> the
 * caller submits.
 *
 * Conventions:
 *   Matrices are column-major, for column vectors. A name says target from source (clipFromView).
 *   Froth derives clip-space conventions (depth direction, viewport sign, off-centre lenses) from the caller's matrix.
 *   Info and status structs begin with structSize = sizeof(the struct), and grow at their end. All others never change;
 *   FrothImage, FrothLens and FrothCamera take additions as FrothExtension.
 *   Zero is the default of every field. Booleans are uint32_t.
 *
 * Threads:
 *   on any thread, at any time:   frothGetRequirements, frothRequireFeatures, frothResultName, frothCompleteRead,
 *                                 frothEstimateMemory, frothStepQuality.
 *   at once on different views:   frothRecordRaster, frothRecordWalk, frothRecordComposite, frothRecordDepthExport (*).
 *   at once on anything:          frothCastRays, frothLocate, frothOverlapSphere (*), frothReadVariant,
 *                                 frothPrecompile.
 *   one at a time per context:    all others; while no call runs at all, frothSetHostAllocator.
 *   (*) while no call of the last row runs.
 *
 * Other headers:
 *   froth_context.h    results, requirements, contexts, memory; included here
 *   froth_camera.h     images, lenses, cameras; included here
 *   froth_reader.h     assets from the engine's own file system
 *   froth_query.h      rays, points and spheres on the CPU
 *   froth_walk.h       rays on the GPU
 *   froth_precompile.h pipelines ahead of time
 *   froth_estimate.h   memory ahead of time
 *   froth_quality.h    scale and cut-off by a target of milliseconds
 *   froth_stream.h     levels of detail by what views see
 *   froth_pool.h       threads for jobs
 *   froth_host.h       the engine's allocator for host memory
 *   froth_composite.h  blending into the engine's colour and depth images
 *   froth_breadcrumbs.h which pass the GPU hung in
 */
#ifndef FROTH_FROTH_H
#define FROTH_FROTH_H

#include "froth/froth_camera.h"
#include "froth/froth_context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A handle is an index and a generation. {0, 0} is null; a call that fails returns it. */
typedef struct FrothAsset {
  uint32_t index, generation;
} FrothAsset;
typedef struct FrothInstance {
  uint32_t index, generation;
} FrothInstance;
typedef struct FrothView {
  uint32_t index, generation;
} FrothView;

/* One part of the GPU memory of an object. */
typedef struct FrothMemory {
  const char* name; /* static storage */
  uint64_t bytes;
} FrothMemory;

/* ---- Assets ---- */

/* OPENING: loading. READY: all uploads are recorded; the same frame can draw it. With FrothContextInfo::hasUploadQueue:
 * all uploads are complete, as completedUploadSerial tells. FAILED: see FrothAssetStatus::error. */
typedef enum FrothAssetState {
  FROTH_ASSET_OPENING = 0,
  FROTH_ASSET_READY = 1,
  FROTH_ASSET_FAILED = 2,
  FROTH_ASSET_STATE_MAX = 0x7fffffff
} FrothAssetState;

typedef struct FrothAssetInfo {
  uint32_t structSize;
  const char* path; /* a .froth file; the string is copied. Give this, or data and dataSize, or reader */
  const void* data; /* bytes of an asset; valid until the asset is READY, FAILED or closed; longer with bytesStay */
  uint64_t dataSize;
  /* layers to load. 1: one colour per cell; 2: detail without view dependence; 3 or 0: all. Any gives a whole scene */
  uint32_t layers;
  /* 1: `data` stays valid until the asset is closed; frothRestoreDevice and frothSetBudget can then load it again */
  uint32_t bytesStay;
  uint32_t keepForQueries; /* 1: keeps in host memory what frothCastRays, frothLocate and frothOverlapSphere need */
  const struct FrothReader* reader; /* copied; froth_reader.h */
  /* 1: where the budget is short, layers of this asset go before cells of views do, and return where there is room
   * (frothSetBudget) */
  uint32_t layersMayGo;
  uint32_t padding;     /* 0; an older header's structure ends behind it */
  uint32_t prepareRays; /* FrothRayPreparation: device memory that makes rays faster (froth_walk.h) */
} FrothAssetInfo;

typedef struct FrothStoredCamera {
  double worldFromCamera[12]; /* 3 rows of 4; axes x right, y down, z forward */
  double tanHalfFovY;
} FrothStoredCamera;

typedef struct FrothAssetStatus {
  uint32_t structSize;
  FrothAssetState state;
  FrothResult error;  /* why a FAILED asset failed */
  uint32_t cellCount; /* cells in the asset */
  uint32_t liveCount; /* cells that can be seen */
  uint32_t detailCount, lobeCount, chunkCount;
  /* splits a cell code (FrothRenderInfo::id): chunk = (uint64_t)code >> cellBits; the lower bits: cell */
  uint32_t cellBits;
  uint32_t hasWalkGraph;
  float nearRatio, nearDepth;       /* the asset's defaults; FROTH_NEAR_DEFAULT */
  float boundsMin[3], boundsMax[3]; /* of the balls of live cells, whole when READY [scene units] */
  uint64_t deviceBytes;             /* resident on the GPU */
  uint32_t hasStartView;
  FrothStoredCamera startView;
  uint32_t flightPathCount; /* number of key frames; frothGetFlightPath */
  uint32_t memoryCount;
  FrothMemory memory[16]; /* [memoryCount] deviceBytes by array, summed over chunks */
  uint64_t hostBytes;     /* host memory kept for queries */
  /* resident, of those that the file has, as FrothAssetInfo::layers counts them; fewer than it was opened with: for the
   * budget (frothSetBudget). detailCount, lobeCount, deviceBytes and memory are of these. 0: the head is not read yet
   */
  uint32_t layers;
  /* FrothRayPreparation that rays of the newest frothRecordWalkSet find. Less than FrothAssetInfo::prepareRays: it is
   * not made yet, or the budget has no room for it (frothSetBudget) */
  uint32_t prepared;
} FrothAssetStatus;

/* Returns at once: FROTH_OK, and the asset is OPENING. The following frothUpdate / frothRecordUpload calls load it. A
 * bad file makes it FAILED and sends one message; frames go on. */
FROTH_API FrothResult frothOpenAsset(FrothContext* context, const FrothAssetInfo* info, FrothAsset* asset);
FROTH_API FrothResult frothGetAssetStatus(FrothContext* context, FrothAsset asset, FrothAssetStatus* status);
/* Copies at most `capacity` key frames. *count: the number that the asset has. capacity 0: cameras may be null. */
FROTH_API FrothResult frothGetFlightPath(FrothContext* context, FrothAsset asset, uint32_t capacity,
                                         FrothStoredCamera* cameras, uint32_t* count);
/* Destroy its instances first. Returns at once, but for an asset of `data` whose bytes a job reads: when the job has
 * ended. Memory is freed when the last frame that uses it is complete, and the last read answered. */
FROTH_API FrothResult frothCloseAsset(FrothContext* context, FrothAsset asset);

/* ---- Instances ---- */

/* An asset placed in the world. Froth reads these fields when a view is drawn. A view shows up to 14 instances. Where
 * instances overlap, their densities add, and each colour counts by its share of the density. The second
 * instance is drawn once its pipelines are made (froth_precompile.h). The motion image leads from where an instance is
 * drawn to where it stood in the newest frame before; a new instance has no motion of its own. */
typedef struct FrothInstanceInfo {
  uint32_t structSize;
  FrothAsset asset;
  double position[3]; /* of the asset's origin, in the world */
  float rotation[4];  /* unit quaternion (x, y, z, w), world from asset; all zero: identity */
  float scale;        /* uniform, > 0; 0: 1 */
  uint32_t mask;      /* visible to views and rays whose mask shares a bit with it; 0: to all */
  uint32_t userId;    /* any number; appears in the id image */
  float exposure;     /* factor on its linear light [>= 0]; 0: 1 */
  uint32_t hasJumped; /* frothSetInstance: 1: it jumped here; leave this movement out of the motion image */
} FrothInstanceInfo;

FROTH_API FrothResult frothCreateInstance(FrothContext* context, const FrothInstanceInfo* info,
                                          FrothInstance* instance);
FROTH_API FrothResult frothSetInstance(FrothContext* context, FrothInstance instance, const FrothInstanceInfo* info);
FROTH_API FrothResult frothDestroyInstance(FrothContext* context, FrothInstance instance);

/* ---- Views: memory and history of one camera ---- */

typedef struct FrothViewInfo {
  uint32_t structSize;
  VkExtent2D maxExtent;   /* [<= 16384 x 16384] largest area that a camera draws; smaller areas allocate nothing */
  uint32_t measurePasses; /* 1: timestamps by pass, read back later without waiting */
  /* FrothLensClass bits that its cameras may use; the context must have them. 0: pinholes only. MAPPED costs 16 bytes
   * per pixel of maxExtent */
  uint32_t lensClasses;
  uint32_t keepsHits; /* 1: its cameras may use id and motion; costs 12 bytes per pixel of maxExtent */
  uint32_t eyeCount;  /* 1 or 2; 0: 1. Two eyes are drawn one after the other and use the same memory */
  /* visible cells of an instance that have room from the first frame on; no more is taken than the asset has cells.
   * 0: 1048576. Later frames of larger assets grow the room by what earlier ones wanted. About 175 bytes per cell, 24
   * per detail site, 16 per plane between cells */
  uint32_t reserveCells;
  FrothView startLike; /* begins with what the newest complete frame of this view wanted; {0, 0}: of none */
  /* 1: its cameras may use reactive too, and it keeps hits; 16 bytes more per pixel. The context has reactiveImages */
  uint32_t keepsReactive;
  /* [<= 64] frothUpdate calls in which an asset with levels of detail fades from a cut to the next (froth_stream.h);
   * 8 bytes per pixel of maxExtent. 0: it changes at once */
  uint32_t fadeFrames;
} FrothViewInfo;

/* Makes room for the READY instances too, so that the view's first frame allocates nothing. */
FROTH_API FrothResult frothCreateView(FrothContext* context, const FrothViewInfo* info, FrothView* view);
/* At once; the memory is freed when the last frame that uses it is complete. */
FROTH_API FrothResult frothDestroyView(FrothContext* context, FrothView view);

/* Limits that a frame reached. The image is valid and incomplete. OVERFLOW bits: the next frothUpdate grows the buffer.
 * LIMIT bits: the caller raises the limit. */
typedef enum FrothViewBit {
  FROTH_VIEW_PAIR_OVERFLOW = 1, /* more (tile, cell) pairs than space; the farthest cells are missing */
  FROTH_VIEW_STEP_LIMIT = 2,    /* FrothRenderInfo::maxSteps or maxNeighbours ended walks */
  FROTH_VIEW_NO_WALK_GRAPH = 4, /* an asset was baked without a walk graph */
  /* an instance was left out: its asset is OPENING or FAILED; or it was created after frothUpdate; or the view's
   * buffers did not fit the budget (a message says so) */
  FROTH_VIEW_NOT_READY = 8,
  FROTH_VIEW_CELL_OVERFLOW = 16,  /* more visible cells, or planes, than space; the smallest on screen are missing */
  FROTH_VIEW_INSTANCE_LIMIT = 32, /* more READY instances than a view shows; those with the highest index are missing */
  FROTH_VIEW_ENTRY_LIMIT = 64,    /* FrothRenderInfo::maxEntries cut lists of tiles; their farthest cells are missing */
  /* returned by the call that records the frame: the view has less room than an asset has cells (reserveCells, or the
   * budget) and no complete frame has shown that it suffices, or the budget refused what the newest one wanted.
   * OVERFLOW bits tell later whether something was missing */
  FROTH_VIEW_MAY_LACK_CELLS = 128,
  /* returned by the call that records the frame: an asset shows fewer layers than it was opened with, for the budget */
  FROTH_VIEW_FEWER_LAYERS = 256,
  FROTH_VIEW_BIT_MAX = 0x7fffffff
} FrothViewBit;

typedef struct FrothPassTime {
  const char* name; /* "aim", "cull", "sort", "bin", "shade", "raster", "walk", "fade" ...; static storage */
  double milliseconds;
} FrothPassTime;

/* What the rays of a frame cost, summed over rays. Needs FrothContextInfo::countWork. */
typedef struct FrothWork {
  uint64_t entries;     /* raster: list entries read; once per workgroup of 8 x 8 pixels */
  uint64_t entriesKept; /* of these: entries that a ray of the workgroup can meet */
  uint64_t ballHits;    /* balls that rays meet */
  uint64_t planes;      /* raster: planes that clipped a ray's interval in a ball */
  uint64_t heights;     /* sums over the detail sites of a cell, for a height */
  uint64_t colours;     /* the same, for a colour: contributions to rays */
  uint64_t steps;       /* walk: steps from cell to cell */
  uint64_t neighbours;  /* walk: neighbours tested in these steps */
} FrothWork;

/* Status of the newest complete frame (FrothFrame::completedSerial). */
typedef struct FrothViewStatus {
  uint32_t structSize;
  uint64_t serial;          /* of that frame; 0: none yet */
  uint32_t bits;            /* FrothViewBit */
  uint32_t visibleCells;    /* cells in view, including those without space in the buffers */
  uint64_t pairs;           /* (tile, cell) pairs */
  uint32_t indexViolations; /* needs FrothContextInfo::checkIndices; must be 0 */
  uint32_t passCount;
  FrothPassTime passes[32]; /* [passCount] needs FrothViewInfo::measurePasses */
  uint64_t deviceBytes;     /* device memory of the view */
  FrothWork work;
  uint32_t memoryCount;
  FrothMemory memory[16]; /* [memoryCount] deviceBytes by purpose */
  uint32_t longestList;   /* raster: entries of the longest list of a tile, as if maxEntries were unlimited */
  uint32_t shownCells;    /* of visibleCells those that had space */
} FrothViewStatus;

FROTH_API FrothResult frothGetViewStatus(FrothContext* context, FrothView view, FrothViewStatus* status);

/* ---- Frames ---- */

typedef struct FrothFrame {
  uint32_t structSize;
  uint64_t serial;          /* [> 0, growing] of the submission that is now recorded */
  uint64_t completedSerial; /* the newest submission that the GPU has completed */
  uint64_t uploadBytes;     /* at most this many bytes are uploaded in this frame; 0: no limit */
  /* without FrothContextInfo::runJob: no other chunk is decoded after so long. 0: after 4 MiB of decoded sections, the
   * same on any machine */
  uint32_t loadMicroseconds;
  /* With FrothContextInfo::hasUploadQueue; else both 0. */
  /* [> 0] of the submission that this frame's frothRecordUpload is recorded for; above that of each submission of
   * uploads before. The number of a submission that is not made, or was dropped, may come again */
  uint64_t uploadSerial;
  /* [< uploadSerial] the newest submission of uploads that the GPU has completed. Assets become READY, and staging
   * memory becomes free, by this number alone */
  uint64_t completedUploadSerial;
} FrothFrame;

typedef struct FrothFrameStatus {
  uint32_t structSize;
  uint32_t assetsOpening; /* 0: nothing is being loaded, but layers that the budget exchanges (frothSetBudget) */
  uint64_t uploadBytesQueued;
  uint64_t deviceBytes; /* all device memory held by the context */
  uint64_t hostBytes;   /* staging and read-back */
  uint64_t excessBytes; /* the part of deviceBytes that exceeds a lowered budget */
  /* with FrothContextInfo::hasUploadQueue: the submission of uploads for whose semaphore this frame's submission waits,
   * at COMPUTE_SHADER and where shaders of the caller walk (froth_walk.h). It is complete: the wait takes no time, and
   * makes visible what was uploaded. 0: wait for nothing */
  uint64_t waitUploadSerial;
} FrothFrameStatus;

/* Begins a frame, which the caller submits or drops. CPU only: frees what complete frames used, loads assets, grows
 * buffers. Never records, never waits for the GPU. Objects created after this call are drawn from the next frame on.
 * status may be null. On an error no frame has begun. FROTH_ERROR_MEMORY: call again. FROTH_ERROR_DEVICE: call
 * frothDeviceLost. */
FROTH_API FrothResult frothUpdate(FrothContext* context, const FrothFrame* frame, FrothFrameStatus* status);

/* Records this frame's uploads. Call it outside a render pass. With FrothContextInfo::hasUploadQueue it records copies
 * and nothing else, into a command buffer for that queue; no frame reads what they write before they are complete. */
FROTH_API FrothResult frothRecordUpload(FrothContext* context, VkCommandBuffer commandBuffer);

/* Call it for a recorded frame that will never be submitted. Its uploads are queued again; assets that need them are
 * OPENING until then. Frames recorded after it read what it would have uploaded: drop them too. With
 * FrothContextInfo::hasUploadQueue it leaves uploads alone. */
FROTH_API FrothResult frothDropFrame(FrothContext* context, uint64_t serial);

/* With FrothContextInfo::hasUploadQueue: call it for uploads that were recorded and will never be submitted. They are
 * queued again. No frame reads them before they are complete, so no other has to be dropped. */
FROTH_API FrothResult frothDropUpload(FrothContext* context, uint64_t uploadSerial);

/* The tone curve at the end of the engine's frame: from scene-linear x to linear light of the display. Per channel,
 * except the last. */
typedef enum FrothToneCurve {
  FROTH_TONE_NONE = 0,
  FROTH_TONE_REINHARD = 1,        /* x / (1 + x) */
  FROTH_TONE_ACES_NARKOWICZ = 2,  /* x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) */
  FROTH_TONE_KHRONOS_NEUTRAL = 3, /* Khronos PBR Neutral */
  FROTH_TONE_MAX = 0x7fffffff
} FrothToneCurve;

/* nearRatio, nearDepth: take the asset's default. */
#define FROTH_NEAR_DEFAULT (-1.0f)

/* Which form of the tile kernel draws a tile: two pixels per thread, or one. */
typedef enum FrothTileForm {
  FROTH_TILE_FORM_BY_LENGTH = 0,
  FROTH_TILE_FORM_ALL_SHORT = 1, /* two pixels per thread */
  FROTH_TILE_FORM_ALL_LONG = 2,  /* one */
  FROTH_TILE_FORM_MAX = 0x7fffffff
} FrothTileForm;

typedef struct FrothRenderInfo {
  uint32_t structSize;
  uint32_t eye; /* [< FrothViewInfo::eyeCount] each eye has its own images, layers, or rectangle (viewport) */
  FrothCamera camera;
  float cutoff; /* a ray ends when its transmittance falls below this; 0: 1e-3; negative: never */
  /* skips cells with |p - eye| < nearRatio * r; 0: off; usually FROTH_NEAR_DEFAULT. Not for parallel rays */
  float nearRatio;
  /* skips cells with forward . (p - eye) < nearDepth [world units]; 0: off; usually FROTH_NEAR_DEFAULT. Only for
   * PROJECTION and RADIAL_TANGENTIAL: other lenses may look sideways or back. Not for parallel rays */
  float nearDepth;
  float quantile;        /* transmittance that defines `distance` and `depth`; 0: one half */
  uint32_t maxSteps;     /* cells of one walk; 0: 65536 */
  uint32_t mask;         /* shows instances whose mask shares a bit with it; 0: all */
  uint32_t displayCoded; /* 1: colour stays display-coded (files, user interfaces); 0: linear */
  /* linear colour is the light that this curve turns into the capture, times exposure. White is 255/256, so light is at
   * most 255 */
  FrothToneCurve toneCurve;

  FrothImage colour; /* R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT: premultiplied colour, 0 to 65504, alpha = 1 - T */
  /* R32_SFLOAT: distance along the ray at which T falls below quantile [world units]; +inf: never */
  FrothImage distance;
  FrothImage normal; /* R16G16B16A16_SFLOAT: sum of T alpha n in world axes, not normalized; w = 0 */
  /* R32_SFLOAT: device depth of the point at `distance`, by clipFromView and the viewport's depth range; its far end:
   * never. With lenses other than PROJECTION: the same as `distance` */
  FrothImage depth;

  /* These two need the feature shaderStorageImageExtendedFormats and FrothViewInfo::keepsHits. */
  /* R32G32_UINT: userId of the instance and code of the cell (FrothAssetStatus::cellBits) at the point at `distance`.
   * No such point: of the last cell that the ray met. No cell met: UINT32_MAX twice */
  FrothImage id;
  /* R16G16_SFLOAT: from the pixel to where previousCamera saw that point, in pixels times motionScale; both without
   * jitter. No such point: motion of a background at infinity (parallel rays: of the plane through the eye). 32768
   * pixels: the point was not in front of that camera */
  FrothImage motion;
  float motionScale[2]; /* 0: 1 */
  /* camera of the previous frame, for motion; jitter and scissor are not read. All zero: there is none (a cut, the
   * first frame), and motion is 0. No ray maps, in this frame or the previous one */
  FrothCamera previousCamera;

  /* Depth of what the engine has drawn; read only. Rays stop there, in the middle of a cell if necessary. D32_SFLOAT,
   * D32_SFLOAT_S8_UINT, D24_UNORM_S8_UINT, X8_D24_UNORM_PACK32, D16_UNORM or R32_SFLOAT; a view of the depth aspect. It
   * holds device depth by clipFromView and the viewport's depth range: reversed and infinite depth need no flag, and
   * the far end stops nothing. With lenses other than PROJECTION: distance along the ray [world units], +inf where
   * there is nothing. */
  FrothImage sceneDepth;

  /* Limits on the work of a frame, for any asset (docs/EMBEDDING.md "Bounds"). */
  /* longest list of a tile of 32 x 32 pixels, per instance: a raster draws the nearest cells that the tile can meet; 0:
   * 16384 */
  uint32_t maxEntries;
  uint32_t maxNeighbours; /* neighbours that one walk tests, without those of its last cell; 0: 1048576 */

  FrothTileForm tileForm; /* for tests of frothRecordRaster; changes no image */

  /* R8_UNORM, for temporal upscalers: how much of the pixel moved otherwise than `motion` says, 0 to 1. The pixel is
   * taken as four quarters, which stand where T falls below 7/8, 5/8, 3/8 and 1/8; one that the ray does not reach is
   * the background of `motion`. Each counts a quarter, times the distance between its own motion and that of the
   * pixel, up to 1 pixel. No previousCamera: 1. Needs what id and motion need, FrothViewInfo::keepsReactive, and no ray
   * map. */
  FrothImage reactive;
} FrothRenderInfo;

/* Draws what a camera sees, by sorted rasterization. Call it outside a render pass, once per view, eye and frame. On
 * exit compute pipeline, sets and push constants are undefined; graphics state is untouched. FROTH_INCOMPLETE:
 * recorded, but something was left out; without any instance the images are cleared. FrothViewStatus::bits of this
 * frame will say why. */
FROTH_API FrothResult frothRecordRaster(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                        const FrothRenderInfo* info);

/* Draws the same image, walking each pixel's ray from cell to cell of the regular triangulation. Rules: as above. */
FROTH_API FrothResult frothRecordWalk(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                      const FrothRenderInfo* info);

#ifdef __cplusplus
}
#endif
#endif
