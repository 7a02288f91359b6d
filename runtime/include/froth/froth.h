/* Froth: a runtime for radiance foams, inside the engine's own Vulkan.
 *
 * What it needs:     Vulkan 1.3 with bufferDeviceAddress and synchronization2, one queue family with COMPUTE.
 * What it does:      records compute work into the caller's command buffers and writes the caller's images.
 * What it never does: submit, wait for the GPU in a frame call, own a queue, create a window, print, abort, keep globals.
 *
 * A frame:  frothUpdate -> frothRecordUpload(cmd) -> frothRasterize(cmd) or frothWalk(cmd) per view -> the caller submits.
 *
 * Conventions: matrices are column-major for column vectors; a name says target from source (clipFromView).
 * Conventions of clip space (depth direction, viewport sign, off-centre lenses) are derived from the caller's matrix.
 * Structs begin with structSize = sizeof(the struct); zero is every field's default. Booleans are uint32_t.
 *
 * Threads: any thread, any time: frothGetRequirements, frothRequireFeatures, frothResultName.
 *          at once on different views: frothRasterize, frothWalk, frothComposite, frothRecordDepthExport; while no call of the last
 *          row runs.
 *          at once on anything: frothCastRays, frothLocate, frothOverlapSphere; while no call of the last row runs.
 *          one thread at a time per context: everything else.
 *
 * Results, requirements, contexts, memory: froth_context.h, which this includes. Single rays, points and spheres on the CPU:
 * froth_query.h; rays on the GPU: froth_walk.h. Into the engine's images: froth_composite.h. docs/EMBEDDING.md leads through it.
 */
#ifndef FROTH_FROTH_H
#define FROTH_FROTH_H

#include "froth/froth_context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Handles are an index and a generation; {0, 0} is null, and what a call that failed gives. */
typedef struct FrothAsset { uint32_t index, generation; } FrothAsset;
typedef struct FrothInstance { uint32_t index, generation; } FrothInstance;
typedef struct FrothView { uint32_t index, generation; } FrothView;

/* A part of what an object holds on the GPU. */
typedef struct FrothMemory {
  const char* name; /* static storage */
  uint64_t bytes;
} FrothMemory;

/* ---- Assets ---- */

/* READY: its last copies are recorded, so the same frame can draw it. */
typedef enum FrothAssetState {
  FROTH_ASSET_OPENING = 0,
  FROTH_ASSET_READY = 1,
  FROTH_ASSET_FAILED = 2,
  FROTH_ASSET_STATE_MAX = 0x7fffffff
} FrothAssetState;

typedef struct FrothAssetInfo {
  uint32_t structSize;
  const char* path; /* a .froth file, copied; or null, and the bytes: */
  const void* data; /* the caller keeps them until the asset is READY, FAILED or closed; or for longer: bytesStay */
  uint64_t dataSize;
  uint32_t layers;  /* how many are loaded; each is a whole scene. 1: one colour per cell; 2: detail without view dependence;
                       3 or 0: all */
  uint32_t bytesStay; /* 1: `data` stays until the asset is closed, so that frothRestoreDevice can load it again */
  uint32_t keepForQueries; /* 1: keeps in host memory what frothCastRays, frothLocate and frothOverlapSphere need */
} FrothAssetInfo;

typedef struct FrothStoredCamera {
  double worldFromCamera[12]; /* 3 rows of 4; axes x right, y down, z forward */
  double tanHalfFovY;
} FrothStoredCamera;

typedef struct FrothAssetStatus {
  uint32_t structSize;
  FrothAssetState state;
  FrothResult error;        /* of a FAILED asset */
  uint32_t cellCount;       /* cells in the asset */
  uint32_t liveCount;       /* cells that can be seen */
  uint32_t detailCount, lobeCount, chunkCount;
  uint32_t cellBits;        /* of a cell code (FrothRenderInfo::id): chunk = (uint64_t)code >> cellBits; cell: the bits below */
  uint32_t hasWalkGraph;
  float nearRatio, nearDepth; /* the asset's defaults */
  float boundsMin[3], boundsMax[3]; /* of the balls of live cells [scene units] */
  uint64_t deviceBytes;     /* resident on the GPU */
  uint32_t hasStartView;
  FrothStoredCamera startView;
  uint32_t flightPathCount; /* key frames; frothGetFlightPath */
  uint32_t memoryCount;
  FrothMemory memory[16];   /* [memoryCount] deviceBytes by array, over all chunks */
  uint64_t hostBytes;       /* kept for queries */
} FrothAssetStatus;

/* Returns FROTH_OK with the asset OPENING; it loads in the following frothUpdate / frothRecordUpload calls. A bad file makes
 * it FAILED, with one message; the frames go on. */
FROTH_API FrothResult frothOpenAsset(FrothContext* context, const FrothAssetInfo* info, FrothAsset* asset);
FROTH_API FrothResult frothGetAssetStatus(FrothContext* context, FrothAsset asset, FrothAssetStatus* status);
/* Copies up to `capacity` key frames; *count gets how many there are. capacity 0: cameras may be null. */
FROTH_API FrothResult frothGetFlightPath(FrothContext* context, FrothAsset asset, uint32_t capacity,
                                         FrothStoredCamera* cameras, uint32_t* count);
/* Returns at once; memory comes back when the last frame that used it is complete. Its instances must be gone. */
FROTH_API FrothResult frothCloseAsset(FrothContext* context, FrothAsset asset);

/* ---- Instances ---- */

/* Read when a view is drawn. A view shows up to 14; where they overlap their densities add, and each colour counts by its share
 * of the density. The first frothUpdate with a second instance makes pipelines for it. Motion leads from where an instance is drawn
 * to where it stood when the newest frame before was; new ones have none. */
typedef struct FrothInstanceInfo {
  uint32_t structSize;
  FrothAsset asset;
  double position[3]; /* of the asset's origin in the world */
  float rotation[4];  /* unit quaternion (x, y, z, w), world from asset; all zero: identity */
  float scale;        /* uniform, > 0; 0: 1 */
  uint32_t mask;      /* seen by views and rays that share a bit with it; 0: by all */
  uint32_t userId;    /* the caller's own name for it; in the id image */
  float exposure;     /* factor on its linear light, >= 0; 0: 1 */
  uint32_t hasJumped; /* of frothSetInstance, 1: it did not move here: no motion from where it was */
} FrothInstanceInfo;

FROTH_API FrothResult frothCreateInstance(FrothContext* context, const FrothInstanceInfo* info, FrothInstance* instance);
FROTH_API FrothResult frothSetInstance(FrothContext* context, FrothInstance instance, const FrothInstanceInfo* info);
FROTH_API FrothResult frothDestroyInstance(FrothContext* context, FrothInstance instance);

/* ---- Views: transients and history of one camera ---- */

typedef struct FrothViewInfo {
  uint32_t structSize;
  VkExtent2D maxExtent;     /* <= 16384 x 16384; largest area that a camera draws; smaller ones allocate nothing */
  uint32_t measurePasses;   /* 1: timestamps by pass, read back later without waiting */
  uint32_t lensClasses;     /* FrothLensClass bits that its cameras may use, of those of the context; 0: pinholes only.
                               MAPPED costs 16 bytes per pixel of maxExtent */
  uint32_t keepsHits;       /* 1: its cameras may ask for id and motion; costs 12 bytes per pixel of maxExtent */
  uint32_t eyeCount;        /* 1 or 2; 0: 1. Two eyes are drawn one after the other, with all memory in common */
} FrothViewInfo;

FROTH_API FrothResult frothCreateView(FrothContext* context, const FrothViewInfo* info, FrothView* view);
/* Returns at once; memory comes back when the last frame that used it is complete. */
FROTH_API FrothResult frothDestroyView(FrothContext* context, FrothView view);

/* Limits that a frame hit. The image is valid and incomplete. The next frothUpdate grows what OVERFLOW bits name; the caller raises
 * what LIMIT bits name. */
typedef enum FrothViewBit {
  FROTH_VIEW_PAIR_OVERFLOW = 1,  /* more (tile, cell) pairs than space; the farthest cells are missing */
  FROTH_VIEW_STEP_LIMIT = 2,     /* walks ended by FrothRenderInfo::maxSteps or maxNeighbours */
  FROTH_VIEW_NO_WALK_GRAPH = 4,  /* the asset was baked without one */
  FROTH_VIEW_NOT_READY = 8,      /* an instance was left out: its asset is OPENING or FAILED, it or the view came after
                                    frothUpdate, or the view's buffers did not fit the budget (a message told) */
  FROTH_VIEW_CELL_OVERFLOW = 16, /* more visible cells, or planes of them, than space; those last in the asset are missing */
  FROTH_VIEW_INSTANCE_LIMIT = 32, /* more READY instances than a view shows; those with the highest index are missing */
  FROTH_VIEW_ENTRY_LIMIT = 64,   /* lists of tiles cut by FrothRenderInfo::maxEntries; their farthest cells are missing */
  FROTH_VIEW_BIT_MAX = 0x7fffffff
} FrothViewBit;

typedef struct FrothPassTime {
  const char* name; /* "aim", "cull", "sort", "bin", "shade", "raster", "walk" ...; static storage */
  double milliseconds;
} FrothPassTime;

/* What the rays of a frame cost, summed; with FrothContextInfo::countWork. */
typedef struct FrothWork {
  uint64_t entries;     /* raster: list entries read, each once per workgroup of 8 x 8 pixels */
  uint64_t entriesKept; /* of these, those that a ray of the workgroup can meet */
  uint64_t ballHits;    /* balls met by rays */
  uint64_t planes;      /* raster: planes that clipped a ray's interval in a ball */
  uint64_t heights;     /* sums over a cell's detail sites for a height */
  uint64_t colours;     /* the same for a colour: contributions to rays */
  uint64_t steps;       /* walk: from cell to cell */
  uint64_t neighbours;  /* walk: neighbours tested in these steps */
} FrothWork;

/* Of the newest frame that is complete (FrothFrame::completedSerial). */
typedef struct FrothViewStatus {
  uint32_t structSize;
  uint64_t serial; /* of that frame; 0: none yet */
  uint32_t bits;   /* FrothViewBit */
  uint32_t visibleCells;     /* in view, those without space included */
  uint64_t pairs;            /* (tile, cell) pairs */
  uint32_t indexViolations;  /* with FrothContextInfo::checkIndices; must be 0 */
  uint32_t passCount;
  FrothPassTime passes[32];  /* with FrothViewInfo::measurePasses */
  uint64_t deviceBytes;      /* of the view's transients */
  FrothWork work;
  uint32_t memoryCount;
  FrothMemory memory[16];    /* [memoryCount] deviceBytes by purpose */
  uint32_t longestList;      /* raster: entries that the longest list of a tile has, or would have without maxEntries */
} FrothViewStatus;

FROTH_API FrothResult frothGetViewStatus(FrothContext* context, FrothView view, FrothViewStatus* status);

/* ---- Frames ---- */

typedef struct FrothFrame {
  uint32_t structSize;
  uint64_t serial;          /* of the submission now recorded: > 0, growing */
  uint64_t completedSerial; /* the newest submission that the GPU has completed */
  uint64_t uploadBytes;     /* most bytes to upload in this frame; 0: no limit */
} FrothFrame;

typedef struct FrothFrameStatus {
  uint32_t structSize;
  uint32_t assetsOpening;    /* 0: nothing is being loaded */
  uint64_t uploadBytesQueued;
  uint64_t deviceBytes;      /* all device memory held by the context */
  uint64_t hostBytes;        /* staging and read-back */
  uint64_t excessBytes;      /* of deviceBytes, beyond a budget that was lowered */
} FrothFrameStatus;

/* Begins a frame, which the caller submits or drops. CPU only: retires what is complete, loads assets, grows buffers. Never
 * records, never waits for the GPU. What is created after it is drawn from the next frame on. status may be null. On an error
 * no frame has begun: FROTH_ERROR_MEMORY can be tried again, FROTH_ERROR_DEVICE asks for frothDeviceLost. */
FROTH_API FrothResult frothUpdate(FrothContext* context, const FrothFrame* frame, FrothFrameStatus* status);

/* Records the copies of this frame; outside a render pass. */
FROTH_API FrothResult frothRecordUpload(FrothContext* context, VkCommandBuffer commandBuffer);

/* Tells that the frame with this serial was recorded and will never be submitted: its uploads queue again, and assets that
 * wait for them are OPENING until then. Frames recorded after it read what it would have uploaded: drop them too. */
FROTH_API FrothResult frothDropFrame(FrothContext* context, uint64_t serial);

/* An image of the caller. image = null: not wanted, and costs nothing. Froth transitions from the entry state and to the exit
 * state, and remembers nothing in between. layoutIn = UNDEFINED drops the contents. */
typedef struct FrothImage {
  VkImage image;
  VkImageView view; /* 2D, one level, identity swizzle; usage STORAGE, of an input SAMPLED */
  uint32_t layer;   /* array layer that `view` shows: the only one that Froth touches */
  VkFormat format;
  VkExtent2D extent;
  VkImageLayout layoutIn, layoutOut;
  VkPipelineStageFlags2 stageIn, stageOut;
  VkAccessFlags2 accessIn, accessOut;
  VkSampleCountFlagBits samples; /* 0 or 1; images of several samples are refused */
} FrothImage;

/* How a camera sees. All but the first take the view's axes as x right, y down, z forward, and no clipFromView. The centre of
 * the image's first pixel is (0.5, 0.5) from the viewport's upper left corner; with
 * (u, v) = (pixel - centre) / focal a pixel sees: */
typedef enum FrothLensKind {
  FROTH_LENS_PROJECTION = 0,        /* as clipFromView says; the fields below are not read */
  FROTH_LENS_FISHEYE = 1,           /* equidistant: |(u, v)| is the angle from the axis */
  FROTH_LENS_KANNALA_BRANDT = 2,    /* OpenCV's fisheye; coefficients k1, k2, k3, k4 */
  FROTH_LENS_RADIAL_TANGENTIAL = 3, /* OpenCV's; coefficients k1, k2, p1, p2, k3, k4, k5, k6 */
  FROTH_LENS_EQUIRECTANGULAR = 4,   /* u is the longitude to the right, v the latitude downwards; focal {0, 0}: the viewport
                                       holds the whole sphere, and centre is not read */
  FROTH_LENS_RAY_MAP = 5,           /* the direction that the caller's image gives */
  FROTH_LENS_MAX = 0x7fffffff
} FrothLensKind;

/* Pixels that no ray of the lens reaches (beyond half a turn, or where a distortion folds: docs/CAMERAS.md) are cleared. */
typedef struct FrothLens {
  FrothLensKind kind;
  float focal[2];        /* [pixels per radian; RADIAL_TANGENTIAL: per tangent], > 0 */
  float centre[2];       /* [pixels] */
  float coefficients[8];
  FrothImage rayMap;     /* RAY_MAP: R32G32B32A32_SFLOAT with usage SAMPLED, read at the pixels that are drawn: xyz a direction of any
                            length in the view's axes, or 0: the pixel is cleared. All rays start at the eye. */
} FrothLens;

typedef struct FrothCamera {
  double eye[3];          /* in the world */
  float viewFromWorld[9]; /* rotation, column-major; the view's axes are those that clipFromView takes */
  float clipFromView[16]; /* unjittered; any perspective projection: reversed, infinite, off-centre, oblique. Row w = (0, 0, 0, w):
                             parallel rays, which start on the plane through the eye, perpendicular to them, and run away
                             from one who sees x to the right and y down on the image; colours as seen along them */
  float jitter[2];        /* [pixels], +x right, +y down; 0 with a ray map, which can hold it */
  VkViewport viewport;    /* negative height too */
  VkRect2D scissor;       /* zero: the whole viewport. What is left must lie in the images and fit maxExtent */
  FrothLens lens;         /* zero: clipFromView is all. Others need their bit in FrothViewInfo::lensClasses */
} FrothCamera;

/* A curve that the engine ends its frame with, from x, scene-linear, to linear light of the display. Per channel but for the last. */
typedef enum FrothToneCurve {
  FROTH_TONE_NONE = 0,
  FROTH_TONE_REINHARD = 1,        /* x / (1 + x) */
  FROTH_TONE_ACES_NARKOWICZ = 2,  /* x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) */
  FROTH_TONE_KHRONOS_NEUTRAL = 3, /* Khronos PBR Neutral */
  FROTH_TONE_MAX = 0x7fffffff
} FrothToneCurve;

/* Marks "take the asset's default" in the two near limits. */
#define FROTH_NEAR_DEFAULT (-1.0f)

/* The form of the raster that draws tiles: with two pixels per thread, or with one. */
typedef enum FrothTileForm {
  FROTH_TILE_FORM_BY_LENGTH = 0,
  FROTH_TILE_FORM_ALL_SHORT = 1, /* two pixels per thread */
  FROTH_TILE_FORM_ALL_LONG = 2,  /* one */
  FROTH_TILE_FORM_MAX = 0x7fffffff
} FrothTileForm;

typedef struct FrothRenderInfo {
  uint32_t structSize;
  uint32_t eye;        /* < FrothViewInfo::eyeCount: images of its own, layers of the same, or a rectangle by the viewport */
  FrothCamera camera;
  float cutoff;        /* a ray ends when its transmittance falls below; 0: 1e-3; negative: never */
  float nearRatio;     /* skips cells with |p - eye| < nearRatio * r; 0: off; usually FROTH_NEAR_DEFAULT. Not for parallel rays */
  float nearDepth;     /* skips cells with forward . (p - eye) < nearDepth [world units]; 0: off; FROTH_NEAR_DEFAULT. Not applied
                          to lenses that may look sideways or back: all but PROJECTION and RADIAL_TANGENTIAL */
  float depthQuantile; /* 0: one half */
  uint32_t maxSteps;   /* of one walk; 0: 65536 */
  uint32_t mask;       /* shows instances that share a bit with it; 0: all */
  uint32_t displayCoded; /* 1: colour stays display-coded (for files); 0: linear */
  FrothToneCurve toneCurve; /* of linear colour: what this curve turns into the capture, times exposure. Its white is 255/256, so that
                               no light is above 255 */

  FrothImage colour;   /* R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT: premultiplied colour, 0 to 65504, alpha = 1 - T */
  FrothImage distance; /* R32_SFLOAT: distance along the ray where T falls below depthQuantile [world units]; +inf: never */
  FrothImage normal;   /* R16G16B16A16_SFLOAT: sum of T alpha n in world axes, not normalized; w = 0 */
  FrothImage depth;    /* R32_SFLOAT: device depth of the point that `distance` means, as clipFromView and the viewport's depth range
                          make it; their far end: never. With lenses other than PROJECTION the same as `distance` */

  /* These two need the feature shaderStorageImageExtendedFormats and FrothViewInfo::keepsHits. */
  FrothImage id;       /* R32G32_UINT: userId of the instance and code of the cell (FrothAssetStatus::cellBits) at the point that
                          `depth` means; where there is none, of the last cell that the ray met; UINT32_MAX twice: it met none */
  FrothImage motion;   /* R16G16_SFLOAT: from the pixel to where that point was seen by previousCamera, in pixels times motionScale, both
                          without jitter; where there is none, of a background at infinity (of parallel rays: on the plane through
                          the eye). 32768 pixels: it was not in front of that camera */
  float motionScale[2];       /* 0: 1 */
  FrothCamera previousCamera; /* of the frame before, for motion; jitter and scissor are not read. All zero: there is none (a cut, the
                                 first frame), and motion is 0. Motion knows no ray maps, now or then */

  /* What the engine has drawn, read only: rays stop there, in the middle of a cell if need be. D32_SFLOAT, D32_SFLOAT_S8_UINT,
   * D24_UNORM_S8_UINT, X8_D24_UNORM_PACK32, D16_UNORM or R32_SFLOAT; a view of the depth aspect. It holds device depth, as
   * clipFromView and the viewport's depth range make it: reversed and infinite depth need no flag, and the far end stops
   * nothing. With lenses other than PROJECTION: distance along the ray [world units], +inf where there is nothing. */
  FrothImage sceneDepth;

  /* What bounds the work of a frame, whatever the assets are (docs/EMBEDDING.md "Bounds"). */
  uint32_t maxEntries;    /* of the list of a tile of 32 x 32 pixels, of each instance: a raster draws the nearest cells that the tile
                             can meet; 0: 16384 */
  uint32_t maxNeighbours; /* that one walk tests on its way from cell to cell, but for those of its last cell; 0: 1048576 */

  FrothTileForm tileForm; /* for tests of frothRasterize; changes no image */
} FrothRenderInfo;

/* Primary visibility by sorted rasterization. Outside a render pass; once per view, eye and frame. On exit compute pipeline, sets
 * and push constants are undefined, graphics state is untouched. FROTH_INCOMPLETE: recorded, but something was left out, and
 * without any instance the images are cleared (FrothViewStatus::bits of this frame will say why). */
FROTH_API FrothResult frothRasterize(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                     const FrothRenderInfo* info);

/* The same image by walking every pixel's ray from cell to cell through the regular triangulation, under the same rules. */
FROTH_API FrothResult frothWalk(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                const FrothRenderInfo* info);

#ifdef __cplusplus
}
#endif
#endif
