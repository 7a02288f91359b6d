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
 *          at once on different views: frothRasterize, frothWalk; while no call of the last row runs.
 *          at once on anything: frothCastRays, frothLocate, frothOverlapSphere; while no call of the last row runs.
 *          one thread at a time per context: everything else.
 *
 * Single rays, points and spheres on the CPU: froth_query.h; rays on the GPU: froth_walk.h. docs/EMBEDDING.md leads through it.
 */
#ifndef FROTH_FROTH_H
#define FROTH_FROTH_H

#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(FROTH_BUILD) && defined(__GNUC__)
#define FROTH_API __attribute__((visibility("default")))
#else
#define FROTH_API
#endif

/* Major in the upper, minor in the lower 16 bits. Creation fails with FROTH_ERROR_VERSION if the major differs. */
#define FROTH_ABI_VERSION 0x00010000u

typedef enum FrothResult {
  FROTH_OK = 0,
  /* information */
  FROTH_PENDING = 1,    /* not yet: something is still under way, and nothing was changed; call again */
  FROTH_INCOMPLETE = 2, /* done, with less than asked for; the status bits say what and which setting to raise */
  /* errors; the message callback got the details */
  FROTH_ERROR_ARGUMENT = -1,    /* a null pointer, a size, an extent, a value out of its range */
  FROTH_ERROR_HANDLE = -2,      /* a stale or foreign handle */
  FROTH_ERROR_VERSION = -3,     /* header and library, or file and library, do not fit */
  FROTH_ERROR_FEATURE = -4,     /* the device lacks, or the caller did not enable, what is required */
  FROTH_ERROR_FILE = -5,        /* the asset is missing, damaged or not one */
  FROTH_ERROR_MEMORY = -6,      /* host or device memory, or the budget, is exhausted */
  FROTH_ERROR_UNSUPPORTED = -7, /* valid, but this version cannot do it, or the object was not made for it (lensClasses) */
  FROTH_ERROR_DEVICE = -8,      /* a Vulkan call failed; the message names it and its VkResult */
  FROTH_ERROR_STATE = -9,       /* calls out of order (asset not READY, frame serial not growing) */
  FROTH_RESULT_MAX = 0x7fffffff
} FrothResult;

FROTH_API const char* frothResultName(FrothResult result); /* never null */

typedef enum FrothSeverity {
  FROTH_SEVERITY_WARNING = 1, /* the call went well, and something will be missing or slow */
  FROTH_SEVERITY_ERROR = 2,   /* a call failed, or an object did on its way */
  FROTH_SEVERITY_MAX = 0x7fffffff
} FrothSeverity;

/* Called on the thread of the failing call. `object` names the asset's path, the view or the call. `text` says cause,
 * place, found value, remedy; it lives during the call only. Must not call Froth. */
typedef void (*FrothMessageCallback)(void* user, FrothSeverity severity, FrothResult code, const char* object,
                                     const char* text);

/* ---- Requirements: pure functions, before a VkDevice exists ---- */

typedef struct FrothRequirement {
  const char* name;   /* "bufferDeviceAddress", "timestampComputeAndGraphics" */
  const char* loss;   /* what is lost without it; null: it is required */
  uint32_t isPresent; /* on the physical device that was asked about; 0 where that was null */
  uint32_t isFeature; /* 1: a feature bit, 0: an extension or limit */
} FrothRequirement;

typedef struct FrothRequirements {
  uint32_t structSize;
  uint32_t apiVersion;  /* least VkApplicationInfo::apiVersion */
  uint32_t isSatisfied; /* all required items are present; 0 where no physical device was given */
  uint32_t itemCount;
  FrothRequirement items[16]; /* [itemCount] strings are static */
} FrothRequirements;

/* `physicalDevice` may be null (then so may the others): the list in general. Sends no messages: the items tell. */
FROTH_API FrothResult frothGetRequirements(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                                           VkPhysicalDevice physicalDevice, FrothRequirements* requirements);

/* ORs the required feature bits into the caller's own chain: VkPhysicalDeviceFeatures2 with, in pNext,
 * VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features, or the single structures of those features.
 * FROTH_ERROR_FEATURE: *missingStructure (may be null) names the structure to add. */
FROTH_API FrothResult frothRequireFeatures(VkPhysicalDeviceFeatures2* features, const char** missingStructure);

/* ---- Context: one per VkDevice ---- */

/* What other cameras than pinholes need: pipelines of a context, memory of a view. */
typedef enum FrothLensClass {
  FROTH_LENS_CLASS_MAPPED = 1,       /* FrothLens::kind other than FROTH_LENS_PROJECTION */
  FROTH_LENS_CLASS_ORTHOGRAPHIC = 2, /* parallel rays */
  FROTH_LENS_CLASS_MAX = 0x7fffffff
} FrothLensClass;

typedef struct FrothContext FrothContext;

/* Memory that Froth asks its caller for. The fields are what vmaAllocateMemory and vkAllocateMemory want to know. */
typedef struct FrothMemoryRequest {
  uint32_t structSize;
  VkMemoryRequirements requirements;
  uint32_t memoryTypeIndex;           /* one of requirements.memoryTypeBits */
  VkMemoryAllocateFlags allocateFlags; /* VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT, or 0 */
  uint32_t isMapped;                  /* 1: host-visible memory that stays mapped; FrothDeviceMemory::mapped is needed */
  const char* purpose;                /* for people; lives during the call */
} FrothMemoryRequest;

typedef struct FrothDeviceMemory {
  VkDeviceMemory memory;
  VkDeviceSize offset; /* a multiple of requirements.alignment */
  void* mapped;        /* address of `offset`; null if not isMapped */
  void* handle;        /* the caller's own, for its free callback */
} FrothDeviceMemory;

/* Fills *memory, which is zero. VK_SUCCESS, or the failure. Called within frothCreateContext, frothCreateView, frothUpdate
 * and frothRestoreDevice, never within a record call; must not call Froth. */
typedef VkResult (*FrothAllocateMemory)(void* user, const FrothMemoryRequest* request, FrothDeviceMemory* memory);
typedef void (*FrothFreeMemory)(void* user, const FrothDeviceMemory* memory);

typedef struct FrothContextInfo {
  uint32_t structSize;
  uint32_t abiVersion; /* FROTH_ABI_VERSION */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device;                /* null: null context; handles and states work, record calls do nothing */
  const VkPhysicalDeviceFeatures2* enabledFeatures; /* the chain the device was made with; read during the call */
  uint32_t queueFamily;           /* the compute-capable family that frames are submitted to */
  VkPipelineCache pipelineCache;  /* may be null; used until the context is destroyed */
  uint32_t framesInFlight;        /* most frames begun and not complete, with the one being recorded [1..8]; 0: 2 */
  uint64_t deviceBudget;          /* [bytes] of device memory for all assets and views; frothSetBudget. 0: no limit */
  FrothMessageCallback onMessage; /* may be null */
  void* messageUser;
  uint32_t checkIndices;          /* debug: shaders check every index; counted in FrothViewStatus::indexViolations */
  uint32_t countWork;             /* for tuning: shaders count FrothViewStatus::work, and are slower for it */
  FrothAllocateMemory allocateMemory; /* both or none: where all VkDeviceMemory comes from; null: vkAllocateMemory */
  FrothFreeMemory freeMemory;
  void* memoryUser;
  uint32_t lensClasses;           /* FrothLensClass bits for which pipelines are made; 0: pinholes only */
  uint32_t walkShaders;           /* 1: rays in the caller's shaders (froth_walk.h); assets hold a table for their starts */
} FrothContextInfo;

/* Makes pipelines and 64 MiB of host-visible staging memory: at start-up, not in a frame. *context is null on an error. */
FROTH_API FrothResult frothCreateContext(const FrothContextInfo* info, FrothContext** context);

/* Frees everything at once. `completedSerial` as in FrothFrame; UINT64_MAX after vkDeviceWaitIdle. FROTH_PENDING: frames
 * beyond it were begun and not dropped; the context stays as it is. A null context is FROTH_OK. */
FROTH_API FrothResult frothDestroyContext(FrothContext* context, uint64_t completedSerial);

/* Changes FrothContextInfo::deviceBudget. What is new never exceeds it. Lowered below what is held: from the next frothUpdate
 * on, views exchange what they grew for less, one buffer after the other, and cells or pairs beyond are missing
 * (FROTH_VIEW_CELL_OVERFLOW, FROTH_VIEW_PAIR_OVERFLOW); what cannot shrink (assets, the least that a view needs) stays, and
 * FrothFrameStatus::excessBytes tells how much it is. Raised: views grow again. */
FROTH_API FrothResult frothSetBudget(FrothContext* context, uint64_t bytes);

/* Memory of one purpose. */
typedef struct FrothMemoryCategory {
  const char* name;   /* "assets", "views", "views, host", "uploads, host", "walks", "walks, host"; static storage */
  uint64_t granted;   /* [bytes] of VkDeviceMemory held */
  uint64_t used;      /* [bytes] of these that hold something */
  uint64_t peak;      /* most granted since creation or the last frothSetBudget */
  uint32_t count;     /* allocations */
  uint32_t isHost;    /* 1: staging and read-back, which the budget does not count */
} FrothMemoryCategory;

typedef struct FrothMemoryReport {
  uint32_t structSize;
  uint32_t categoryCount;
  uint64_t deviceBudget;
  uint64_t deviceBytes; /* granted, over the categories that are not host */
  uint64_t devicePeak;  /* since creation or the last frothSetBudget; <= deviceBudget, except as excessBytes told */
  FrothMemoryCategory categories[8]; /* [categoryCount] */
} FrothMemoryReport;

FROTH_API FrothResult frothGetMemoryReport(FrothContext* context, FrothMemoryReport* report);

/* When a Vulkan call anywhere gave VK_ERROR_DEVICE_LOST (a call of Froth then gives FROTH_ERROR_DEVICE and says so): drops all
 * GPU objects without waiting, by destroying them; call it before vkDestroyDevice. Handles stay valid. Until the device is
 * restored, assets are OPENING, frame calls give FROTH_ERROR_DEVICE, and objects may be made, changed and destroyed. */
FROTH_API FrothResult frothDeviceLost(FrothContext* context);

/* Goes on with a new device; all fields of `info` count, as for frothCreateContext. Frames that were in flight are forgotten,
 * and serials go on growing. Assets load again in the following frames, from their path or from bytes that stay
 * (FrothAssetInfo::bytesStay; an asset whose bytes do not becomes FAILED), those that were FAILED too. On an error the device
 * stays lost; call it again. */
FROTH_API FrothResult frothRestoreDevice(FrothContext* context, const FrothContextInfo* info);

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
 * of the density. The first frothUpdate with a second instance makes pipelines for it. */
typedef struct FrothInstanceInfo {
  uint32_t structSize;
  FrothAsset asset;
  double position[3]; /* of the asset's origin in the world */
  float rotation[4];  /* unit quaternion (x, y, z, w), world from asset; all zero: identity */
  float scale;        /* uniform, > 0; 0: 1 */
  uint32_t mask;      /* seen by views and rays that share a bit with it; 0: by all */
  uint32_t userId;    /* the caller's own name for it */
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
} FrothViewInfo;

FROTH_API FrothResult frothCreateView(FrothContext* context, const FrothViewInfo* info, FrothView* view);
/* Returns at once; memory comes back when the last frame that used it is complete. */
FROTH_API FrothResult frothDestroyView(FrothContext* context, FrothView view);

/* Limits that a frame hit. The image is valid and incomplete; the next frothUpdate grows what the bit names. */
typedef enum FrothViewBit {
  FROTH_VIEW_PAIR_OVERFLOW = 1,  /* more (tile, cell) pairs than space; the farthest cells are missing */
  FROTH_VIEW_STEP_LIMIT = 2,     /* walks ended by FrothRenderInfo::maxSteps */
  FROTH_VIEW_NO_WALK_GRAPH = 4,  /* the asset was baked without one */
  FROTH_VIEW_NOT_READY = 8,      /* an instance was left out: its asset is OPENING or FAILED, it or the view came after
                                    frothUpdate, or the view's buffers did not fit the budget (a message told) */
  FROTH_VIEW_INSTANCE_LIMIT = 32, /* more READY instances than a view shows; those with the highest index are missing */
  FROTH_VIEW_CELL_OVERFLOW = 16, /* more visible cells, or planes of them, than space; those last in the asset are missing */
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
  FrothPassTime passes[16];  /* with FrothViewInfo::measurePasses */
  uint64_t deviceBytes;      /* of the view's transients */
  FrothWork work;
  uint32_t memoryCount;
  FrothMemory memory[8];     /* [memoryCount] deviceBytes by purpose */
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

/* Marks "take the asset's default" in the two near limits. */
#define FROTH_NEAR_DEFAULT (-1.0f)

typedef struct FrothRenderInfo {
  uint32_t structSize;
  FrothCamera camera;
  float cutoff;        /* a ray ends when its transmittance falls below; 0: 1e-3; negative: never */
  float nearRatio;     /* skips cells with |p - eye| < nearRatio * r; 0: off; usually FROTH_NEAR_DEFAULT. Not for parallel rays */
  float nearDepth;     /* skips cells with forward . (p - eye) < nearDepth [world units]; 0: off; FROTH_NEAR_DEFAULT. Not applied
                          to lenses that may look sideways or back: all but PROJECTION and RADIAL_TANGENTIAL */
  float depthQuantile; /* 0: one half */
  uint32_t maxSteps;   /* of one walk; 0: 65536 */
  uint32_t mask;       /* shows instances that share a bit with it; 0: all */
  uint32_t displayCoded; /* 1: colour stays display-coded (for files); 0: linear */

  FrothImage colour;   /* R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT: premultiplied colour, alpha = 1 - T */
  FrothImage distance; /* R32_SFLOAT: distance along the ray where T falls below depthQuantile [world units]; +inf: never */
  FrothImage normal;   /* R16G16B16A16_SFLOAT: sum of T alpha n in world axes, not normalized; w = 0 */
  FrothImage depth;    /* R32_SFLOAT: device depth of the point that `distance` means, as clipFromView and the viewport's depth range
                          make it; their far end: never. With lenses other than PROJECTION the same as `distance` */

  /* What the engine has drawn, read only: rays stop there, in the middle of a cell if need be. D32_SFLOAT, D32_SFLOAT_S8_UINT,
   * D24_UNORM_S8_UINT, X8_D24_UNORM_PACK32, D16_UNORM or R32_SFLOAT; a view of the depth aspect. It holds device depth, as
   * clipFromView and the viewport's depth range make it: reversed and infinite depth need no flag, and the far end stops
   * nothing. With lenses other than PROJECTION: distance along the ray [world units], +inf where there is nothing. */
  FrothImage sceneDepth;
} FrothRenderInfo;

/* Primary visibility by sorted rasterization. Outside a render pass; once per view and frame. On exit compute pipeline, sets
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
