/* Froth, contexts: what a call gives back, what a device must have, one context per VkDevice, its memory, and a device that is lost.
 *
 * Included by froth.h, which says what holds for all calls. */
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
  VkFormat compositeFormat;       /* of frothComposite's target (froth_composite.h): R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT or, with
                                     shaderStorageImageExtendedFormats, B10G11R11_UFLOAT_PACK32; UNDEFINED: it is not called */
  VkFormat depthExportFormat;     /* of frothRecordDepthExport's attachment, one that the device has; needs dynamicRendering, and a
                                     queue family with GRAPHICS; UNDEFINED: it is not called */
  uint32_t floatColours;          /* for tests: frothRasterize and frothWalk keep colours of detail sites as floats between their
                                     passes, where they are halves; the images lack that rounding */
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

#ifdef __cplusplus
}
#endif
#endif
