// Rays through the foam, with what else floats in it. Included first: it enables extensions.
#define FROTH_WALK_SET 1
#define FROTH_WALK_ALONE      // the room has one foam: for whole rays,
#define FROTH_WALK_STREAMS 1  // and for those in segments
layout(constant_id = 0) const uint prepared = 0;  // FrothRayPreparation of the foam
#define FROTH_WALK_PREPARED prepared
#include "froth_walk.glsl"
#include "room.glsl"

const float kLift = 1e-3;  // [metres] by which rays start off a surface, whose position was rounded

bool hasFoam() { return room.counts.y != 0; }

// Share of light that comes through the foam along a part of a ray.
float throughFoam(vec3 origin, vec3 direction, float tMax) {
  if (!hasFoam()) return 1.0;
  FrothRay ray = frothRay(origin, direction);
  ray.tMin = kLift;
  ray.tMax = tMax;
  uint status;
  return frothTransmittance(ray, status);
}
