// An engine's compute shader: a thread per ray calls what `mode` says.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#include "clashes.glsl"
layout(constant_id = 0) const uint whatIsPrepared = 0;
#define FROTH_WALK_PREPARED whatIsPrepared
#define FROTH_WALK_SET 0
#include "froth_walk.glsl"

layout(local_size_x = 64) in;

struct Asked {
  vec4 originMin, directionMax;
  uvec4 hint;
};
struct Answer {
  vec4 first, second, third;
  uvec4 fourth;
};
layout(buffer_reference, std430) readonly buffer AskedArray { Asked v[]; };
layout(buffer_reference, std430) writeonly buffer AnswerArray { Answer v[]; };
layout(push_constant) uniform Push {
  AskedArray asked;
  AnswerArray answers;
  uint count, mode;
} push;

// The whole ray, and its parts before and behind tMax.
Answer splitRay(FrothRay ray) {
  float split = ray.tMax;
  ray.tMax = FROTH_INFINITY;
  FrothHit hit;
  vec4 whole = frothRadiance(ray, hit);
  FrothWalk walk = frothBeginWalk(ray);
  vec4 parts[2];
  for (int i = 0; i < 2; ++i) parts[i] = frothRadianceSegment(walk, i == 0 ? split : FROTH_INFINITY);
  return Answer(whole, parts[0], parts[1],
                uvec4(hit.status, hit.instance, hit.cell == walk.hit.cell ? 1 : 0, hit.userId));
}

Answer findClosest(FrothRay ray) {
  FrothHit hit;
  bool isHit = frothClosest(ray, hit);
  uint status;
  float transmittance = frothTransmittance(ray, status);
  return Answer(vec4(hit.normal, hit.distance), vec4(transmittance, isHit ? 1.0 : 0.0, 0.0, 0.0), vec4(0.0),
                uvec4(hit.instance, hit.chunk, hit.cell, hit.status));
}

Answer locate(FrothRay ray) {
  uvec2 cell;
  bool isThere = frothLocate(ray.hint.x, ray.origin, ray.hint.yz, cell);
  return Answer(vec4(0.0), vec4(0.0), vec4(0.0), uvec4(isThere ? 1 : 0, cell, 0));
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= push.count) return;
  Asked asked = push.asked.v[index];
  FrothRay ray = frothRay(asked.originMin.xyz, asked.directionMax.xyz);
  ray.tMin = asked.originMin.w;
  ray.tMax = asked.directionMax.w;
  ray.hint = asked.hint;
  Answer answer = push.mode == 0 ? splitRay(ray) : push.mode == 1 ? findClosest(ray) : locate(ray);
  push.answers.v[index] = answer;
}
