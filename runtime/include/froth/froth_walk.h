/* Froth, rays on the GPU: in the caller's own shaders (froth_walk.glsl), or cast by Froth from a buffer.
 *
 * For shadows, mirrors, probes, picking. A frame: frothUpdate -> frothRecordUpload(cmd) -> frothRecordWalkSet(cmd) -> the
 * caller's passes with the set bound, or frothRecordRays(cmd). Needs FrothContextInfo::walkShaders. Near tests
 * (FrothRenderInfo::nearRatio) do not apply: they belong to cameras.
 *
 * Threads: one at a time per context, as frothUpdate. */
#ifndef FROTH_FROTH_WALK_H
#define FROTH_FROTH_WALK_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The set's layout and the include's structures. The include has the same number: a shader that was compiled with another one
 * meets nothing and says FROTH_WALK_VERSION. */
#define FROTH_WALK_ABI 3u

/* Of one set. */
#define FROTH_WALK_MOST_INSTANCES 64u

typedef struct FrothWalkInfo {
  uint32_t structSize;
  double eye[3];     /* rays are given relative to this point of the world, in float: near to what they will meet */
  float cutoff;      /* [< 1] a ray ends when its transmittance falls below; 0: 1e-3; negative: never */
  float quantile;    /* [0 < q < 1] transmittance at which a ray counts as stopped; 0: one half */
  uint32_t maxSteps; /* of one ray in one instance; 0: 65536 */
  VkPipelineStageFlags2 stages; /* shader stages that will read the set; 0: compute and fragment */
  uint32_t maxNeighbours; /* that one ray tests in one instance, but for those of its last cell; 0: 1048576 */
} FrothWalkInfo;

/* Binding 0: a uniform buffer; binding 1: a storage buffer; all stages. Valid as long as the context's device; identically
 * defined in all contexts. With a null context: null. */
FROTH_API FrothResult frothGetWalkSetLayout(FrothContext* context, VkDescriptorSetLayout* layout);

/* Records what shaders need to walk through all READY instances as they are placed now; once per frame, outside a render pass.
 * *set may be bound in command buffers of this frame that come after this one in submission order. FROTH_INCOMPLETE: an instance
 * was left out: not READY, without a walk graph, newer than frothUpdate, or more than FROTH_WALK_MOST_INSTANCES. With a null
 * context *set is null. */
FROTH_API FrothResult frothRecordWalkSet(FrothContext* context, VkCommandBuffer commandBuffer, const FrothWalkInfo* info,
                                         VkDescriptorSet* set);

/* Arrays in the caller's buffers: their layout is fixed. */
typedef struct FrothGpuRay {
  float origin[3];    /* relative to FrothWalkInfo::eye */
  float tMin;         /* [world units] */
  float direction[3]; /* of any length but 0 */
  float tMax;         /* 0: no end */
  float apex;         /* colours are seen from the point that lies this far behind the origin: FrothRay in froth_walk.glsl */
  uint32_t mask;      /* meets instances that share a bit with it; 0: all */
  uint32_t flags, padding; /* 0 */
} FrothGpuRay;

typedef struct FrothGpuHit {
  float colour[3];     /* premultiplied, linear, without FrothInstanceInfo::exposure; with FROTH_RAY_RADIANCE */
  float transmittance; /* over the ray's part; of a ray that ended early, up to there */
  float normal[3];     /* of the face of the cell that stops the ray, in world axes, unit; 0: none does */
  float distance;      /* where transmittance falls below the quantile [world units]; +inf: never */
  uint32_t instance;   /* of the set; 0xffffffff as chunk and cell: none */
  uint32_t chunk, cell;
  uint32_t userId;     /* FrothInstanceInfo::userId of the instance */
  uint32_t status;     /* FrothWalkBit */
  uint32_t steps;      /* cells walked through */
  uint32_t padding[2];
} FrothGpuHit;

/* FrothHit::status, FrothGpuHit::status. */
typedef enum FrothWalkBit {
  FROTH_WALK_STATUS_DONE = 0,
  FROTH_WALK_STATUS_STEP_LIMIT = 1,   /* ended by FrothWalkInfo::maxSteps or maxNeighbours: what lies beyond is missing */
  FROTH_WALK_STATUS_STREAM_LIMIT = 2, /* an instance was left out: more overlap at once than FROTH_WALK_STREAMS (4) */
  FROTH_WALK_STATUS_VERSION = 3,      /* shader and library do not fit */
  FROTH_WALK_STATUS_MAX = 0x7fffffff
} FrothWalkBit;

typedef enum FrothRayKind {
  FROTH_RAY_TRANSMITTANCE = 0, /* of the whole ray, and where it is stopped */
  FROTH_RAY_CLOSEST = 1,       /* ends where it is stopped */
  FROTH_RAY_RADIANCE = 2,      /* colour too */
  FROTH_RAY_KIND_MAX = 0x7fffffff
} FrothRayKind;

/* Casts `count` rays with the walk set of this frame: after frothRecordWalkSet. rays: FrothGpuRay [count], hits: FrothGpuHit
 * [count], by device address, multiples of 16. Read and written in the compute stage as storage; barriers before and after are
 * the caller's. On exit compute pipeline, sets and push constants are undefined. */
FROTH_API FrothResult frothRecordRays(FrothContext* context, VkCommandBuffer commandBuffer, VkDeviceAddress rays,
                                      VkDeviceAddress hits, uint32_t count, FrothRayKind kind);

/* Of the newest complete frame with a walk set. Rays count in shaders compiled without FROTH_WALK_NO_COUNTERS; the caller's own need
 * a memory barrier behind them, from their stages and SHADER_STORAGE_WRITE to HOST and HOST_READ, before the host sees what they
 * counted. frothRecordRays records its own. */
typedef struct FrothWalkStatus {
  uint32_t structSize;
  uint64_t serial;          /* of that frame; 0: none yet */
  uint32_t stepLimits;      /* rays ended by maxSteps or maxNeighbours */
  uint32_t versions;        /* rays of shaders that do not fit the library */
  uint32_t indexViolations; /* of frothRecordRays, with FrothContextInfo::checkIndices; must be 0 */
  /* with FrothContextInfo::countWork, summed over rays: */
  uint64_t rays;
  uint64_t descents;   /* cells on the way to where a walk begins */
  uint64_t cells;      /* walked through */
  uint64_t neighbours; /* tested in these */
  uint64_t cellsMet;   /* whose ball a ray meets */
  uint64_t sites;      /* detail sites whose colour was found */
} FrothWalkStatus;

FROTH_API FrothResult frothGetWalkStatus(FrothContext* context, FrothWalkStatus* status);

#ifdef __cplusplus
}
#endif
#endif
