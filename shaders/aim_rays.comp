// The rays of a mapped lens, and the cones around those of each sub-tile and tile. A workgroup per tile, four pixels of
// one sub-tile per thread. FROTH_RAY_IMAGE: the caller's image gives the directions, in the view's axes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/pixel_cones.glsl"
#include "foam/lens.h"

const uint kThreads = 256;
const uint kPixels = kTileSize * kTileSize / kThreads;                 // of a thread
const uint kSubTileThreads = kThreads / kSubTilesPerTile;
layout(local_size_x = kThreads) in;

#if defined(FROTH_RAY_IMAGE)
layout(set = 0, binding = kBindingRayMap) uniform texture2D rayImage;
#endif

shared vec3 sums[kThreads];    // of directions
shared float chords[kThreads];  // longest from an axis to a direction; -1: no direction

// In the view's axes, not normalized; 0: none.
vec3 lensDirection(uvec2 pixel) {
#if defined(FROTH_RAY_IMAGE)
  vec3 given = texelFetch(rayImage, ivec2(pixel + uvec2(FRAME.regionX, FRAME.regionY)), 0).xyz;
  return any(isnan(given)) || any(isinf(given)) ? vec3(0.0) : given;
#else
  vec2 point = FRAME.lensPoint.xy + vec2(pixel) * FRAME.lensPoint.zw;
  vec3 direction;
  bool isSeen = lensRay(int(FRAME.lensKind), point, FRAME.lensFirst, FRAME.lensSecond, FRAME.lensRange, direction);
  return isSeen ? direction : vec3(0.0);
#endif
}

// In the asset's axes, of unit length; 0: none.
vec3 aim(uvec2 pixel) {
  if (pixel.x >= FRAME.regionWidth || pixel.y >= FRAME.regionHeight) return vec3(0.0);
  vec3 seen = lensDirection(pixel);
  float largest = max(abs(seen.x), max(abs(seen.y), abs(seen.z)));
  vec3 direction = vec3(0.0);
  if (largest > 0.0) {
    seen /= largest;
    direction = normalize(seen.x * FRAME.rayX.xyz + seen.y * FRAME.rayY.xyz + seen.z * FRAME.rayOrigin.xyz);
  }
  FRAME.rays.v[pixel.y * FRAME.regionWidth + pixel.x] = vec4(direction, 0.0);
  return direction;
}

// The cone around the directions of `threads` threads, which share `axis`; each of them ends with it.
vec4 coneAround(vec3 axis, vec3 directions[kPixels], uint threads) {
  uint thread = gl_LocalInvocationIndex;
  float chord = -1.0;
  for (uint i = 0; i < kPixels; ++i) {
    if (directions[i] == vec3(0.0)) continue;
    float own = length(directions[i] - axis);
    chord = own < 1.0 ? max(chord, own) : 2.0;
  }
  chords[thread] = chord;
  barrier();
  for (uint stride = threads / 2; stride > 0; stride /= 2) {
    if (thread % threads < stride) chords[thread] = max(chords[thread], chords[thread + stride]);
    barrier();
  }
  float longest = chords[thread - thread % threads];
  barrier();
  return longest < 0.0 ? vec4(axis, kConeOfNone) : coneOfChord(axis, longest);
}

vec3 axisOf(vec3 sum) {
  float size = length(sum);
  return size > 0.0 ? sum / size : vec3(0.0, 0.0, 1.0);
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint subTile = thread / kSubTileThreads;
  uvec2 tile = gl_WorkGroupID.xy;
  uvec2 corner = tile * kTileSize + uvec2(subTile % 4, subTile / 4) * kSubTileSize;
  vec3 directions[kPixels];
  vec3 sum = vec3(0.0);
  for (uint i = 0; i < kPixels; ++i) {
    uint place = thread % kSubTileThreads * kPixels + i;
    directions[i] = aim(corner + uvec2(place % kSubTileSize, place / kSubTileSize));
    sum += directions[i];
  }
  sums[thread] = sum;
  barrier();
  for (uint stride = kSubTileThreads / 2; stride > 0; stride /= 2) {
    if (thread % kSubTileThreads < stride) sums[thread] += sums[thread + stride];
    barrier();
  }
  vec3 subTileSum = sums[subTile * kSubTileThreads];
  vec3 tileSum = vec3(0.0);
  for (uint i = 0; i < kSubTilesPerTile; ++i) tileSum += sums[i * kSubTileThreads];

  vec4 subTileCone = coneAround(axisOf(subTileSum), directions, kSubTileThreads);
  if (thread % kSubTileThreads == 0) FRAME.cones.v[tileIndex(tile) * kSubTilesPerTile + subTile] = subTileCone;
  vec4 tileCone = coneAround(axisOf(tileSum), directions, kThreads);
  if (thread == 0) FRAME.cones.v[tileConeAt(tileIndex(tile))] = tileCone;
}
