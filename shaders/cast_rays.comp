// The rays of frothRecordRays. A thread per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require

layout(constant_id = 0) const bool checkIndices = false;
layout(constant_id = 1) const uint kind = 0;  // FrothRayKind
layout(constant_id = 2) const uint prepared = 0;  // kPreparedNothing...
layout(constant_id = 3) const bool countsWork = false;
#define FROTH_WALK_COUNTS countsWork
#define FROTH_WALK_PREPARED prepared
#define FROTH_WALK_CHECK_INDICES checkIndices
#include "froth_walk.glsl"
#include "gpu/grid.glsl"

layout(local_size_x = kRayGroupSize) in;

// FrothGpuRay, FrothGpuHit of froth_walk.h.
struct RayRecord {
  vec4 originMin, directionMax;  // origin, tMin; direction, tMax, 0: none
  float apex;
  uint mask, flags, padding;
};

struct HitRecord {
  vec4 colourTransmittance, normalDistance;
  uvec4 place;  // instance, chunk, cell, userId
  uvec4 status;
};

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer RayArray { RayRecord v[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer HitArray { HitRecord v[]; };

layout(push_constant) uniform Push {
  RayArray rays;
  HitArray hits;
  uint count;
} push;

const uint kClosest = 1;
const uint kRadiance = 2;

FrothRay loadRay(uint index) {
  RayRecord record = push.rays.v[index];
  FrothRay ray = frothRay(record.originMin.xyz, normalize(record.directionMax.xyz));
  ray.tMin = record.originMin.w;
  if (record.directionMax.w != 0.0) ray.tMax = record.directionMax.w;
  ray.apex = record.apex;
  ray.colours = record.flags & FROTH_COLOURS_BASE;  // FROTH_RAY_BASE_COLOURS is the same bit
  if (record.mask != 0) ray.mask = record.mask;
  return ray;
}

void main() {
  uint group = linearGroup();
  uint index = group * kRayGroupSize + gl_LocalInvocationIndex;
  if (index >= push.count) return;
  Passage passage = castRay(loadRay(index), kind == kRadiance, kind == kClosest);
  FrothHit hit = passage.hit;
  push.hits.v[index] =
      HitRecord(vec4(passage.radiance.rgb, passage.transmittance), vec4(hit.normal, hit.distance),
                uvec4(hit.instance, hit.chunk, hit.cell, hit.userId), uvec4(hit.status, passage.cells, 0u, 0u));
}
