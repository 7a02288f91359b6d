/* Froth, queries: single rays, points and spheres, on the CPU.
 *
 * For gameplay and servers. They answer on the calling thread, wait for nothing, and need neither a GPU nor a frame: a null
 * context serves them. They see the instances whose asset was opened with keepForQueries and has been READY once, as they are
 * placed now; a lost device changes nothing. Positions are in the world, in double. Near tests (FrothRenderInfo::nearRatio)
 * do not apply: they belong to cameras.
 *
 * Their errors (a null pointer, a number out of its range: nothing is written) are told on the calling thread. */
#ifndef FROTH_FROTH_QUERY_H
#define FROTH_FROTH_QUERY_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Why an answer is less than asked for. The call then gives FROTH_INCOMPLETE. */
typedef enum FrothQueryBit {
  FROTH_QUERY_STEP_LIMIT = 1,    /* ended by FrothCastInfo::maxSteps or maxNeighbours: what lies beyond is missing */
  FROTH_QUERY_NO_WALK_GRAPH = 2, /* an instance was left out: its asset was baked without the graph that queries walk */
  FROTH_QUERY_NOT_READY = 4,     /* an instance was left out: its asset is OPENING for the first time, or FAILED */
  FROTH_QUERY_BIT_MAX = 0x7fffffff
} FrothQueryBit;

/* The part tMin <= t <= tMax of origin + t direction / |direction|. The foam is met as by a ray that starts at tMin. Rays and
 * hits come in arrays: their layout is fixed. */
typedef struct FrothRay {
  double origin[3];
  double direction[3]; /* finite, of any length but 0 */
  double tMin;         /* >= 0, finite [world units] */
  double tMax;         /* >= 0 [world units]; 0: no end; below tMin: nothing is met */
} FrothRay;

typedef struct FrothRayHit {
  double distance;        /* from the origin, where transmittance falls below the quantile [world units]; +inf: never */
  double position[3];     /* there; 0 if never, as what follows */
  float normal[3];        /* of the face of the cell that is met there, unit */
  FrothInstance instance; /* where several overlap: the densest */
  uint32_t chunk, cell;   /* of its asset */
  float transmittance;    /* over the ray's part; of a ray that ended early, up to there */
  uint32_t steps;         /* cells walked through */
  uint32_t bits;          /* FrothQueryBit; 0: done */
} FrothRayHit;

typedef struct FrothCastInfo {
  uint32_t structSize;
  float quantile;       /* [0 < q < 1] transmittance at which a ray counts as stopped; 0: one half */
  float cutoff;         /* [< 1] a ray ends when its transmittance falls below; 0: 1e-3; negative: never */
  uint32_t maxSteps;    /* of one ray in one instance; 0: 65536 */
  uint32_t closestOnly; /* 1: a ray ends at `distance`; transmittance is then that behind the cell that it met */
  uint32_t maxNeighbours; /* that one ray tests in one instance on its way, but for those of its last cell; 0: 1048576 */
} FrothCastInfo;

/* Casts `count` rays one by one. Where instances overlap, their densities add. info may be null: all defaults. */
FROTH_API FrothResult frothCastRays(FrothContext* context, const FrothCastInfo* info, const FrothRay* rays,
                                    FrothRayHit* hits, uint32_t count);

/* The power cell that holds a point: the one with the least |point - site|^2 - radius^2. Every point of space has one. */
typedef struct FrothLocation {
  uint32_t structSize;
  uint32_t chunk, cell;
  uint32_t isLive; /* 0: a cell that only fills space */
  double power;    /* that least value [square world units]; negative: inside the cell's ball */
} FrothLocation;

/* FROTH_ERROR_STATE: the asset was never READY, FAILED or was opened without keepForQueries. FROTH_ERROR_UNSUPPORTED: it has no
 * walk graph. */
FROTH_API FrothResult frothLocate(FrothContext* context, FrothInstance instance, const double point[3],
                                  FrothLocation* location);

/* The solid: the union of the cells that stop light, 1 - exp(-2 radius density) >= opacity. Of each the part of its ball that lies
 * in its power cell and below its face, which is taken as flat, at the mean of its detail heights. */
typedef struct FrothSphere {
  uint32_t structSize;
  double centre[3];
  double radius;  /* >= 0, finite [world units]; the time grows with the cells that it meets up to the nearest solid */
  float opacity;  /* [0 < a < 1] of a cell that counts as solid, across its whole ball; 0: one half */
} FrothSphere;

/* The deepest contact: the point of the solid that is nearest to the sphere's centre. A centre inside of the solid is led out
 * through the face of the cell that holds it. */
typedef struct FrothContact {
  uint32_t structSize;
  uint32_t isTouching;    /* 0: the sphere is free, and what follows is 0 but for the bits */
  double position[3];     /* of the contact, on the solid */
  float normal[3];        /* unit, from the solid towards the centre */
  double depth;           /* >= 0: how far to move the sphere along the normal to free it of this cell [world units] */
  FrothInstance instance;
  uint32_t chunk, cell;   /* of its asset */
  uint32_t bits;          /* FrothQueryBit */
} FrothContact;

FROTH_API FrothResult frothOverlapSphere(FrothContext* context, const FrothSphere* sphere, FrothContact* contact);

#ifdef __cplusplus
}
#endif
#endif
