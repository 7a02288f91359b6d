/* Froth, rays on the GPU: in the caller's shaders (froth_walk.glsl, froth_walk.slang), or cast by Froth from a buffer.
 *
 * For shadows, mirrors, probes, picking. Needs FrothContextInfo::walkShaders. Near tests (FrothRenderInfo::nearRatio)
 * do not apply:
 * they belong to cameras.
 *
 * A frame:  frothUpdate -> frothRecordUpload(cmd) -> frothRecordWalkSet(cmd) -> the caller's passes with the set bound,
 * or
 *           frothRecordRays(cmd).
 *
 * Threads: one at a time per context, as frothUpdate. */
#ifndef FROTH_FROTH_WALK_H
#define FROTH_FROTH_WALK_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the set's layout and of the include's structures. The include holds the same number. A shader that was
 * compiled with another number meets nothing and returns FROTH_WALK_VERSION. */
#define FROTH_WALK_ABI 8u

/* FrothAssetInfo::prepareRays: what is kept in device memory so that rays need not decode cells. Images and hits are
 * the same with each but for the rounding of last digits. frothRecordRays uses what all instances of the set have;
 * shaders of an engine what FROTH_WALK_PREPARED says (froth_walk.glsl). Bytes: frothEstimateMemory beforehand,
 * FrothAssetStatus::memory ("cells prepared for rays") after; docs/PERFORMANCE.md says what they buy. Made on the
 * device by frothRecordWalkSet once the asset, or a chunk of its levels, is there: within what FrothFrame::uploadBytes
 * leaves, but for one chunk. Until all that is drawn is made, and where the budget takes its memory (frothSetBudget),
 * rays find nothing prepared: FrothAssetStatus::prepared. Nothing without FrothContextInfo::walkShaders, or without a
 * walk graph. */
typedef enum FrothRayPreparation {
  FROTH_PREPARE_NOTHING = 0,
  /* planes and faces, and heights if the asset has such: for FROTH_RAY_TRANSMITTANCE and FROTH_RAY_CLOSEST. 16 bytes
   * per neighbour of a cell, 32 per live cell, with heights 16 per detail site */
  FROTH_PREPARE_VISIBILITY = 1,
  /* detail sites and lobes too: for FROTH_RAY_RADIANCE. 32 bytes per detail site in all, 16 per lobe, or 32 where lobes
   * are stored without loss */
  FROTH_PREPARE_RADIANCE = 2,
  FROTH_RAY_PREPARATION_MAX = 0x7fffffff
} FrothRayPreparation;

/* In one set. */
#define FROTH_WALK_MOST_INSTANCES 64u

typedef struct FrothWalkInfo {
  uint32_t structSize;
  double eye[3];     /* rays are relative to this point of the world, in float; choose it near what they will meet */
  float cutoff;      /* [< 1] a ray ends when its transmittance falls below this; 0: 1e-3; negative: never */
  float quantile;    /* [0 < q < 1] transmittance at which a ray counts as stopped; 0: one half */
  uint32_t maxSteps; /* cells of one ray in one instance; 0: 65536 */
  VkPipelineStageFlags2 stages; /* shader stages that read the set; 0: compute, and fragment if the family has it */
  /* neighbours that one ray tests in one instance, without those of its last cell; 0: 1048576 */
  uint32_t maxNeighbours;
} FrothWalkInfo;

/* Binding 0: a uniform buffer; binding 1: a storage buffer; all stages. Valid as long as the context's device.
 * Identically defined in all contexts. A null context gives null. */
FROTH_API FrothResult frothGetWalkSetLayout(FrothContext* context, VkDescriptorSetLayout* layout);

/* Records the data with which shaders walk through all READY instances, where they are placed now. Call it once per
 * frame, outside a render pass. *set may be bound in this frame's command buffers that follow this one in submission
 * order. FROTH_INCOMPLETE: an instance was left out: it is not READY, has no walk graph, was created after frothUpdate,
 * or there are more than FROTH_WALK_MOST_INSTANCES. A null context gives *set null. */
FROTH_API FrothResult frothRecordWalkSet(FrothContext* context, VkCommandBuffer commandBuffer,
                                         const FrothWalkInfo* info, VkDescriptorSet* set);

/* Elements of arrays in the caller's buffers: their layout is fixed. */
typedef struct FrothGpuRay {
  float origin[3];    /* relative to FrothWalkInfo::eye */
  float tMin;         /* [world units] */
  float direction[3]; /* any length but 0 */
  float tMax;         /* 0: no end */
  float apex;         /* colours are seen from the point this far behind the origin; FrothRay in froth_walk.glsl */
  uint32_t mask;      /* meets instances whose mask shares a bit with it; 0: all */
  uint32_t flags;     /* FrothRayFlag bits */
  uint32_t padding;   /* 0 */
} FrothGpuRay;

typedef enum FrothRayFlag {
  /* of FROTH_RAY_RADIANCE: without view dependence, as an asset with `layers` 2 shows its colours. Cheaper, for what is
   * seen in mirrors (docs/PERFORMANCE.md) */
  FROTH_RAY_BASE_COLOURS = 1,
  FROTH_RAY_FLAG_MAX = 0x7fffffff
} FrothRayFlag;

typedef struct FrothGpuHit {
  float colour[3];     /* FROTH_RAY_RADIANCE: premultiplied, linear, times FrothInstanceInfo::exposure */
  float transmittance; /* along the ray; if the ray ended early, up to its end */
  float normal[3];     /* of the face of the cell that stops the ray, in world axes, unit; 0: no cell stops it */
  /* from the ray's origin, whatever its tMin, to where transmittance falls below the quantile [world units, whatever
   * the length of `direction`]; +inf: never. The hit distance of denoisers (docs/EMBEDDING.md "Denoisers") */
  float distance;
  uint32_t instance; /* index in the set; 0xffffffff, as chunk and cell: none */
  uint32_t chunk, cell;
  uint32_t userId; /* FrothInstanceInfo::userId of the instance */
  uint32_t status; /* FrothWalkEnd */
  uint32_t steps;  /* cells walked through */
  uint32_t padding[2];
} FrothGpuHit;

/* FrothHit::status, FrothGpuHit::status: one of these. */
typedef enum FrothWalkEnd {
  FROTH_WALK_DONE = 0,
  /* FrothWalkInfo::maxSteps or maxNeighbours ended it; what lies beyond is missing */
  FROTH_WALK_STEP_LIMIT = 1,
  /* an instance was left out: more than FROTH_WALK_STREAMS (4) overlap at once; the shader defines FROTH_WALK_ALONE and
   * the set has more than one; or frothRecordRays cannot meet several yet, for their pipelines are being made: then it
   * meets the first, as views draw it */
  FROTH_WALK_STREAM_LIMIT = 2,
  FROTH_WALK_VERSION = 3,    /* shader and library do not match */
  FROTH_WALK_UNPREPARED = 4, /* shader: FROTH_WALK_PREPARED is more than is prepared of an instance of the set */
  FROTH_WALK_END_MAX = 0x7fffffff
} FrothWalkEnd;

typedef enum FrothRayKind {
  FROTH_RAY_TRANSMITTANCE = 0, /* transmittance along the whole ray, and where it is stopped */
  FROTH_RAY_CLOSEST = 1,       /* the same, but the ray ends where it is stopped */
  FROTH_RAY_RADIANCE = 2,      /* the same as TRANSMITTANCE, and colour */
  FROTH_RAY_KIND_MAX = 0x7fffffff
} FrothRayKind;

/* Casts `count` rays with the walk set of this frame; call it after frothRecordWalkSet. rays: FrothGpuRay [count],
 * hits: FrothGpuHit [count]; device addresses, multiples of 16. The compute stage reads and writes them as storage; the
 * caller records the barriers before and after. On exit compute pipeline, sets and push constants are undefined. */
FROTH_API FrothResult frothRecordRays(FrothContext* context, VkCommandBuffer commandBuffer, VkDeviceAddress rays,
                                      VkDeviceAddress hits, uint32_t count, FrothRayKind kind);

/* Counters of the newest complete frame with a walk set. Shaders compiled without FROTH_WALK_NO_COUNTERS count. After
 * the caller's own shaders the caller records a memory barrier, from their stages and SHADER_STORAGE_WRITE to HOST and
 * HOST_READ; the host then sees the counts. frothRecordRays records its own barrier. */
typedef struct FrothWalkStatus {
  uint32_t structSize;
  uint64_t serial;          /* of that frame; 0: none yet */
  uint32_t stepLimits;      /* rays that maxSteps or maxNeighbours ended */
  uint32_t versions;        /* rays of shaders that do not match the library */
  uint32_t indexViolations; /* of frothRecordRays; needs FrothContextInfo::checkIndices; must be 0 */
  /* need FrothContextInfo::countWork; summed over rays: */
  uint64_t rays;
  uint64_t descents;    /* cells visited in the search for the first cell */
  uint64_t cells;       /* cells walked through */
  uint64_t neighbours;  /* neighbours tested in these */
  uint64_t cellsMet;    /* cells whose ball the ray meets */
  uint64_t detailSites; /* detail sites whose colour was evaluated */
} FrothWalkStatus;

FROTH_API FrothResult frothGetWalkStatus(FrothContext* context, FrothWalkStatus* status);

#ifdef __cplusplus
}
#endif
#endif
