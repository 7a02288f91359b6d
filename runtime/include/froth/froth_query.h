/* Froth, queries: single rays, points and spheres, on the CPU.
 *
 * For gameplay and servers. A query answers on the calling thread and waits for nothing. It needs no GPU and no frame;
 * a null context is enough. Queries see the instances whose asset was opened with keepForQueries and has been READY
 * once, where they are placed now; of levels of detail the cells that are drawn since the last frothUpdate. A lost
 * device changes nothing. Positions are in the world, in double. Near tests (FrothRenderInfo::nearRatio) do not apply:
 * they belong to cameras.
 *
 * On an error (a null pointer, a number out of its range) nothing is written; the message comes on the calling
 * thread. */
#ifndef FROTH_FROTH_QUERY_H
#define FROTH_FROTH_QUERY_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Why an answer is incomplete. The call then returns FROTH_INCOMPLETE. */
typedef enum FrothQueryBit {
  FROTH_QUERY_STEP_LIMIT = 1,    /* FrothCastInfo::maxSteps or maxNeighbours ended it; what lies beyond is missing */
  FROTH_QUERY_NO_WALK_GRAPH = 2, /* an instance was left out: its asset was baked without walk graph */
  FROTH_QUERY_NOT_READY = 4,     /* an instance was left out: its asset is OPENING for the first time, or FAILED */
  FROTH_QUERY_BIT_MAX = 0x7fffffff
} FrothQueryBit;

/* The part tMin <= t <= tMax of origin + t direction / |direction|. It meets the foam as a ray that starts at tMin.
 * Rays and hits are array elements: their layout is fixed. */
typedef struct FrothRay {
  double origin[3];
  double direction[3]; /* finite, any length but 0 */
  double tMin;         /* [>= 0, finite, world units] */
  double tMax;         /* [>= 0, world units] 0: no end; below tMin: the ray meets nothing */
} FrothRay;

typedef struct FrothRayHit {
  /* from the origin to where transmittance falls below the quantile [world units]; +inf: never */
  double distance;
  double position[3];     /* of that point; if there is none, this and what follows, down to cell, is 0 */
  float normal[3];        /* of the face of the cell at that point, unit */
  FrothInstance instance; /* if several overlap there: the densest */
  uint32_t chunk, cell;   /* of its asset */
  float transmittance;    /* along the ray; if the ray ended early, up to its end */
  uint32_t steps;         /* cells walked through */
  uint32_t bits;          /* FrothQueryBit; 0: done */
} FrothRayHit;

typedef struct FrothCastInfo {
  uint32_t structSize;
  float quantile;       /* [0 < q < 1] transmittance at which a ray counts as stopped; 0: one half */
  float cutoff;         /* [< 1] a ray ends when its transmittance falls below this; 0: 1e-3; negative: never */
  uint32_t maxSteps;    /* cells of one ray in one instance; 0: 65536 */
  uint32_t closestOnly; /* 1: a ray ends at `distance`; transmittance is then the one behind that cell */
  /* neighbours, and in open space balls, that a ray tests in one instance, without its last cell's; 0: 1048576 */
  uint32_t maxNeighbours;
} FrothCastInfo;

/* Casts `count` rays one by one. Where instances overlap, their densities add. info null: all defaults. */
FROTH_API FrothResult frothCastRays(FrothContext* context, const FrothCastInfo* info, const FrothRay* rays,
                                    FrothRayHit* hits, uint32_t count);

/* The power cell that holds a point: the cell with the least power |point - site|^2 - radius^2. Every point of space
 * has one. */
typedef struct FrothLocation {
  uint32_t structSize;
  uint32_t chunk, cell;
  uint32_t isLive; /* 0: a cell that shows nothing and only fills space */
  double power;    /* the least power [square world units]; negative: inside the cell's ball */
} FrothLocation;

/* FROTH_ERROR_STATE: the asset was never READY, is FAILED, or was opened without keepForQueries.
 * FROTH_ERROR_UNSUPPORTED: it has no walk graph. */
FROTH_API FrothResult frothLocate(FrothContext* context, FrothInstance instance, const double point[3],
                                  FrothLocation* location);

/* A sphere to test against the solid. A cell is solid if 1 - exp(-2 radius density) >= opacity. The solid is the union
 * of these cells: of each, the part of its ball inside its power cell and below its face. The face is flat, at the mean
 * of its detail heights. */
typedef struct FrothSphere {
  uint32_t structSize;
  double centre[3];
  /* [>= 0, finite, world units] the time grows with the cells that the sphere meets up to the nearest solid */
  double radius;
  float opacity; /* [0 < a < 1] least opacity of a solid cell, across its whole ball; 0: one half */
} FrothSphere;

/* The deepest contact: the point of the solid nearest to the sphere's centre. If the centre is inside the solid, the
 * contact leads out through the face of the cell that holds it. */
typedef struct FrothContact {
  uint32_t structSize;
  uint32_t isTouching; /* 0: the sphere is free; what follows is 0, except the bits */
  double position[3];  /* of the contact, on the solid's surface */
  float normal[3];     /* unit, from the solid towards the centre */
  double depth;        /* [>= 0, world units] moving the sphere this far along the normal frees it of this cell */
  FrothInstance instance;
  uint32_t chunk, cell; /* of its asset */
  uint32_t bits;        /* FrothQueryBit */
} FrothContact;

FROTH_API FrothResult frothOverlapSphere(FrothContext* context, const FrothSphere* sphere, FrothContact* contact);

#ifdef __cplusplus
}
#endif
#endif
