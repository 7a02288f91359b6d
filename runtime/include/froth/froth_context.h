/* Froth, contexts: results, device requirements, contexts, memory, device loss.
 *
 * Included by froth.h, which states the conventions of all calls. */
#ifndef FROTH_FROTH_CONTEXT_H
#define FROTH_FROTH_CONTEXT_H

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

/* Major in the upper 16 bits, minor in the lower. Context creation fails with FROTH_ERROR_VERSION if the major
 * differs. */
#define FROTH_ABI_VERSION 0x00010000u

typedef enum FrothResult {
  FROTH_OK = 0,
  /* information */
  FROTH_PENDING = 1,    /* not yet: something is still in progress; nothing was changed; call again */
  FROTH_INCOMPLETE = 2, /* done, but something is missing; the status bits say what, and which setting to raise */
  /* errors; the message callback received the details */
  FROTH_ERROR_ARGUMENT = -1, /* a null pointer, a wrong size or extent, a value out of its range */
  FROTH_ERROR_HANDLE = -2,   /* a stale or foreign handle */
  FROTH_ERROR_VERSION = -3,  /* header and library, or file and library, do not match */
  FROTH_ERROR_FEATURE = -4,  /* the device lacks a required feature, or the caller did not enable it */
  FROTH_ERROR_FILE = -5,     /* the file is missing, damaged or no asset */
  FROTH_ERROR_MEMORY = -6,   /* host or device memory, or the budget, is exhausted */
  /* valid, but this version cannot do it, or the object was not created for it (lensClasses) */
  FROTH_ERROR_UNSUPPORTED = -7,
  FROTH_ERROR_DEVICE = -8, /* a Vulkan call failed; the message names it and its VkResult */
  FROTH_ERROR_STATE = -9,  /* calls out of order (asset not READY, frame serial not growing) */
  FROTH_RESULT_MAX = 0x7fffffff
} FrothResult;

FROTH_API const char* frothResultName(FrothResult result); /* never null */

typedef enum FrothSeverity {
  FROTH_SEVERITY_WARNING = 1, /* the call succeeded, but something will be missing or slow */
  FROTH_SEVERITY_ERROR = 2,   /* a call failed, or an object failed later */
  FROTH_SEVERITY_MAX = 0x7fffffff
} FrothSeverity;

/* Called on the thread of the failing call. `object` names the asset's path, the view or the call. `text` states cause,
 * place, found value and remedy; it is valid during the call only. The callback must not call Froth. */
typedef void (*FrothMessageCallback)(void* user, FrothSeverity severity, FrothResult code, const char* object,
                                     const char* text);

/* ---- Requirements: pure functions, before a VkDevice exists ---- */

typedef struct FrothRequirement {
  const char* name;   /* "bufferDeviceAddress", "timestampComputeAndGraphics" */
  const char* loss;   /* what is lost without it; null: the item is required */
  uint32_t isPresent; /* on the given physical device; 0 if that was null */
  uint32_t isFeature; /* 1: a feature bit, 0: an extension or limit */
} FrothRequirement;

typedef struct FrothRequirements {
  uint32_t structSize;
  uint32_t apiVersion;  /* lowest valid VkApplicationInfo::apiVersion */
  uint32_t isSatisfied; /* all required items are present; 0 if no physical device was given */
  uint32_t itemCount;
  FrothRequirement items[16]; /* [itemCount] static strings */
} FrothRequirements;

/* physicalDevice null: the general list; the other handles may then be null too. Sends no messages. */
FROTH_API FrothResult frothGetRequirements(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                                           VkPhysicalDevice physicalDevice, FrothRequirements* requirements);

/* ORs the required feature bits into the caller's chain: VkPhysicalDeviceFeatures2 with
 * VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features in pNext, or the single structures of those
 * features. FROTH_ERROR_FEATURE: *missingStructure names the structure to add. missingStructure may be null. */
FROTH_API FrothResult frothRequireFeatures(VkPhysicalDeviceFeatures2* features, const char** missingStructure);

/* ---- Context: one per VkDevice ---- */

/* Cameras other than pinholes. Each class needs pipelines of the context and memory of the view. */
typedef enum FrothLensClass {
  FROTH_LENS_CLASS_MAPPED = 1,       /* FrothLens::kind other than FROTH_LENS_PROJECTION */
  FROTH_LENS_CLASS_ORTHOGRAPHIC = 2, /* parallel rays */
  FROTH_LENS_CLASS_MAX = 0x7fffffff
} FrothLensClass;

typedef struct FrothContext FrothContext;

/* Memory that Froth requests from the caller. The fields are the input of vmaAllocateMemory and vkAllocateMemory. */
typedef struct FrothMemoryRequest {
  uint32_t structSize;
  VkMemoryRequirements requirements;
  uint32_t memoryTypeIndex;            /* one of requirements.memoryTypeBits */
  VkMemoryAllocateFlags allocateFlags; /* VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT, or 0 */
  /* 1: host-visible memory that stays mapped; FrothDeviceMemory::mapped is needed */
  uint32_t isMapped;
  const char* purpose; /* for people; valid during the call */
} FrothMemoryRequest;

typedef struct FrothDeviceMemory {
  VkDeviceMemory memory;
  VkDeviceSize offset; /* a multiple of requirements.alignment */
  void* mapped;        /* host address of `offset`; null if not isMapped */
  void* handle;        /* any value; returned to the caller's free callback */
} FrothDeviceMemory;

/* Fills *memory, which is zero on entry. Returns VK_SUCCESS or the failure. Froth calls it in frothCreateContext,
 * frothCreateView, frothUpdate and frothRestoreDevice, never in a record call; with FrothContextInfo::runJob not in
 * frothUpdate but in a job, perhaps at once with the others. It must not call Froth. The same holds for
 * FrothFreeMemory. */
typedef VkResult (*FrothAllocateMemory)(void* user, const FrothMemoryRequest* request, FrothDeviceMemory* memory);
typedef void (*FrothFreeMemory)(void* user, const FrothDeviceMemory* memory);

/* Work that no frame need wait for: it decodes one chunk of an asset at most, or makes pipelines, or takes and frees
 * device memory. It waits for nothing, so one thread is enough. */
typedef void (*FrothJob)(void* argument);
/* Takes a job and returns. The job is called once, with its argument, on any thread: later, also after
 * frothDestroyContext (it then does nothing), or before this returns. A job that is never called leaks memory. Called
 * in frothUpdate. froth_pool.h has one. */
typedef void (*FrothRunJob)(void* user, FrothJob job, void* argument);

typedef struct FrothContextInfo {
  uint32_t structSize;
  uint32_t abiVersion; /* FROTH_ABI_VERSION */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device; /* null: a null context; handles and states work, record calls do nothing */
  /* the chain that the device was created with; read during the call */
  const VkPhysicalDeviceFeatures2* enabledFeatures;
  uint32_t queueFamily;          /* family with compute to which frames are submitted */
  VkPipelineCache pipelineCache; /* may be null; used until the context is destroyed */
  /* [1..8] most frames begun and not complete, including the one being recorded; 0: 2 */
  uint32_t framesInFlight;
  /* [bytes] limit of device memory for all assets and views; frothSetBudget changes it. 0: no limit */
  uint64_t deviceBudget;
  FrothMessageCallback onMessage; /* may be null */
  void* messageUser;
  /* debug: shaders check every index and count faults in FrothViewStatus::indexViolations */
  uint32_t checkIndices;
  uint32_t countWork;                 /* for tuning: shaders count FrothViewStatus::work; they are slower */
  FrothAllocateMemory allocateMemory; /* both or none; they provide all VkDeviceMemory; null: vkAllocateMemory */
  FrothFreeMemory freeMemory;
  void* memoryUser;
  uint32_t lensClasses; /* FrothLensClass bits; pipelines are made for these; 0: pinholes only */
  uint32_t walkShaders; /* 1: enables froth_walk.h; assets then hold a table of entries for rays */
  /* target of frothRecordComposite (froth_composite.h): R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT or, with
   * shaderStorageImageExtendedFormats, B10G11R11_UFLOAT_PACK32. UNDEFINED: no frothRecordComposite */
  VkFormat compositeFormat;
  /* attachment of frothRecordDepthExport; a format of the device. Needs dynamicRendering and a queue family with
   * GRAPHICS. UNDEFINED: no frothRecordDepthExport */
  VkFormat depthExportFormat;
  /* for tests: colours of detail sites are floats instead of halves between the passes of frothRecordRaster and
   * frothRecordWalk */
  uint32_t floatColours;
  /* runs what frothUpdate would do itself: null: assets load within frothUpdate (FrothFrame::loadMicroseconds) */
  FrothRunJob runJob;
  void* jobUser;
  uint32_t mostJobs; /* [<= 64] jobs that are given to runJob and not ended, beside one of memory; 0: 4 */
  /* [>= 65536 bytes] of host-visible memory through which assets are uploaded. The frames in flight share it, so a
   * frame uploads this part of it at most, whatever its uploadBytes. 0: 16 MiB */
  uint64_t stagingBytes;
  /* 1: pipelines are made so that full frames can write FrothRenderInfo::reactive. Those frames are slower, whether
   * they have that image or not; frames of colour and distance alone are the same */
  uint32_t reactiveImages;
  /* 1: uploads are submissions of their own, with serials of their own (FrothFrame::uploadSerial), to a queue of
   * uploadQueueFamily. 0: uploads stand in the frames */
  uint32_t hasUploadQueue;
  /* any family with TRANSFER, COMPUTE or GRAPHICS; may be queueFamily. What uploads write is shared by the two families
   * (VK_SHARING_MODE_CONCURRENT): it needs no ownership transfer */
  uint32_t uploadQueueFamily;
  /* 1: the GPU tells which passes it begins and finishes: froth_breadcrumbs.h; frames are slower */
  uint32_t breadcrumbs;
} FrothContextInfo;

/* Makes pipelines and the staging memory. Call it at start-up, not in a frame. *context is null on
 * an error. */
FROTH_API FrothResult frothCreateContext(const FrothContextInfo* info, FrothContext** context);

/* Frees everything at once; waits for jobs that have begun. completedSerial: as in FrothFrame; UINT64_MAX after
 * vkDeviceWaitIdle. FROTH_PENDING, and nothing is freed: later frames were begun and not dropped; or, below UINT64_MAX,
 * uploads were recorded beyond the last completedUploadSerial; or, when none were, reads are not answered
 * (froth_reader.h), and now are cancelled. A null pointer gives FROTH_OK. */
FROTH_API FrothResult frothDestroyContext(FrothContext* context, uint64_t completedSerial);

/* Changes FrothContextInfo::deviceBudget. New allocations never exceed it, but for exchanges, below. Where the budget
 * is short, what is prepared for rays goes (FrothAssetInfo::prepareRays), of an asset at once, with one warning; then
 * cells go; before them view dependence, then detail, of the assets that allow it (FrothAssetInfo::layersMayGo).
 *
 * A budget below the bytes held is obeyed within frames: from the next frothUpdate on, views exchange their buffers for
 * smaller ones, one after the other; cells or pairs without space are missing (FROTH_VIEW_CELL_OVERFLOW,
 * FROTH_VIEW_PAIR_OVERFLOW). Then, one at a time and for as long as views lack space, such assets load once more with
 * fewer layers (FrothAssetStatus::layers, FROTH_VIEW_FEWER_LAYERS; one warning each) and are exchanged at the edge of a
 * frame; views then grow again. Until then the smaller asset stands beside the larger one: views make room for it, and
 * where that is not enough, the budget is exceeded by its bytes at most. An asset of bytes without bytesStay keeps its
 * layers, as does one that failed to load once more (one warning).
 *
 * One colour per cell and the least that a view needs stay; FrothFrameStatus::excessBytes tells by how much they exceed
 * the budget.
 *
 * Where there is room: views grow; once they hold what they want, layers return, one at a time, where the larger asset
 * fits beside the smaller one; then cells are prepared for rays again, of an asset with levels of detail where there is
 * room for all of its chunks. */
FROTH_API FrothResult frothSetBudget(FrothContext* context, uint64_t bytes);

/* Memory of one purpose. */
typedef struct FrothMemoryCategory {
  const char* name; /* "assets", "views", "views, host", "uploads, host", "walks", "walks, host"; static storage */
  uint64_t granted; /* [bytes] VkDeviceMemory held */
  uint64_t used;    /* [bytes] the part of `granted` that is in use */
  uint64_t peak;    /* [bytes] highest `granted` since creation or the last frothSetBudget */
  uint32_t count;   /* number of allocations */
  uint32_t isHost;  /* 1: staging and read-back; not part of the budget */
} FrothMemoryCategory;

typedef struct FrothMemoryReport {
  uint32_t structSize;
  uint32_t categoryCount;
  uint64_t deviceBudget;
  uint64_t deviceBytes; /* sum of `granted` over the categories with isHost 0 */
  uint64_t devicePeak;  /* since creation or the last frothSetBudget; <= deviceBudget, except by excessBytes */
  FrothMemoryCategory categories[8]; /* [categoryCount] */
} FrothMemoryReport;

FROTH_API FrothResult frothGetMemoryReport(FrothContext* context, FrothMemoryReport* report);

/* Call it after any Vulkan call returned VK_ERROR_DEVICE_LOST, and before vkDestroyDevice. (A call of Froth that meets
 * a lost device returns FROTH_ERROR_DEVICE and says so.) Destroys all GPU objects without waiting. Handles stay valid.
 * Until frothRestoreDevice assets are OPENING and frame calls return FROTH_ERROR_DEVICE; objects may be created,
 * changed and destroyed. */
FROTH_API FrothResult frothDeviceLost(FrothContext* context);

/* Continues with a new device. All fields of `info` count, as for frothCreateContext. Frames that were in flight are
 * forgotten; serials go on growing. All assets, FAILED ones too, load again in the following frames: from their path,
 * through their reader, or from their bytes with FrothAssetInfo::bytesStay. An asset of bytes without bytesStay becomes
 * FAILED. On an error the device stays lost; call it again. */
FROTH_API FrothResult frothRestoreDevice(FrothContext* context, const FrothContextInfo* info);

#ifdef __cplusplus
}
#endif
#endif
