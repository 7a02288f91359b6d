#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "room.glsl"

// What pixels without rays of their own show of sunlight and reflections: the mean of those rays around them that start
// on the same surface, or of all where none does. After Kopf et al., "Joint Bilateral Upsampling" (2007), whose weights
// are 0 or 1 here.

struct Mean {
  vec4 sum;
  float count;
};

void add(vec4 shown, inout Mean mean) {
  mean.sum += shown;
  mean.count += 1.0;
}

vec4 meanOf(Mean same, Mean any) { return same.count > 0.0 ? same.sum / same.count : any.sum / any.count; }

void main() {
  ivec2 pixel = thisPixel(), step = ivec2(room.counts.z), low = pixel / step * step;
  if (!isInImage(pixel) || low == pixel) return;
  Surface surface = surfaceAt(pixel);
  Shown shown = shownBy(surface, pixel);
  const Mean nothing = Mean(vec4(0.0), 0.0);
  Mean sameSun = nothing, anySun = nothing, sameSeen = nothing, anySeen = nothing;
  for (int i = 0; i < 4; ++i) {  // two, or four
    ivec2 other = low + ivec2(i & 1, i >> 1) * step * ivec2(notEqual(low, pixel));
    if (!isInImage(other)) continue;
    Surface neighbour = surfaceAt(other);
    vec4 sun = imageLoad(sunlightImage, other), seen = imageLoad(reflectionImage, other);
    add(sun, anySun);
    add(seen, anySeen);
    if (showsSame(shown, shownBy(neighbour, other))) add(sun, sameSun);
    if (isSameSurface(surface, neighbour)) add(seen, sameSeen);
  }
  imageStore(sunlightImage, pixel, meanOf(sameSun, anySun));
  imageStore(reflectionImage, pixel, meanOf(sameSeen, anySeen));
}
