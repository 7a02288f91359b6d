#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "room.glsl"

// Light on the meshes, and what they reflect, behind the foam that stands before them.

// Mean over the sixteen pixels whose rays were spread together, of those that show the same surface. Where none does, of
// all: between rays something may be thinner than they stand apart.
float smoothSurround(ivec2 pixel, Surface surface, bool isInMirror) {
  Shown shown = Shown(surface, isInMirror);
  int step = room.counts.z;
  vec2 same = vec2(0.0), whole = vec2(0.0);  // sums, and of how many
  for (int i = 0; i < 16; ++i) {
    ivec2 other = pixel / step * step + step * (ivec2(i & 3, i >> 2) - 1);
    if (any(lessThan(other, ivec2(0))) || !isInImage(other)) continue;
    Shown neighbour = shownAt(other);
    vec4 shares = imageLoad(surroundImage, other);
    vec2 share = vec2(neighbour.isInMirror ? shares.y : shares.x, 1.0);
    whole += share;
    if (showsSame(shown, neighbour)) same += share;
  }
  return same.y > 0.0 ? same.x / same.y : whole.x / whole.y;
}

// Light of a surface towards one who looks along `along`; what mirrors and glossy meshes reflect comes on top.
vec3 litSurface(ivec2 pixel, Surface surface, vec3 along, bool isInMirror) {
  vec4 sunShares = imageLoad(sunlightImage, pixel);
  float sunShare = isInMirror ? sunShares.y : sunShares.x;
  vec4 colour = room.materials[surface.material].colour;
  vec3 sun = room.sun.rgb * (sunShare * max(dot(surface.normal, room.toSun.xyz), 0.0));
  vec3 light = sun + smoothSurround(pixel, surface, isInMirror) * surroundingLight(surface.normal);
  vec3 lit = colour.rgb * light;
  if (isGlossy(surface)) {  // Blinn's highlight of the sun
    vec3 middle = normalize(room.toSun.xyz - along);
    float shininess = 2.0 / pow(max(colour.w, 0.02), 4.0);
    lit += sun * (0.04 * 0.125 * (shininess + 8.0) * pow(max(dot(middle, surface.normal), 0.0), shininess));
  }
  return lit;
}

float fresnel(float cosine) { return 0.04 + 0.96 * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0); }

// The meshes in the mirror: the engine's second sight of them. Their own reflections are of the surroundings alone.
vec3 lightInMirror(ivec2 pixel, vec3 along) {
  Surface beyond = mirroredSurfaceAt(pixel);
  if (!beyond.isThere) return surroundingLight(along);
  vec3 light = litSurface(pixel, beyond, along, true);
  if (isGlossy(beyond)) {
    light += fresnel(-dot(along, beyond.normal)) * surroundingLight(reflect(along, beyond.normal));
  }
  return light;
}

vec3 lightOfMeshes(ivec2 pixel, Surface surface, vec3 along) {
  if (!surface.isThere) return surroundingLight(along);
  vec4 foam = imageLoad(reflectionImage, pixel);
  if (isMirror(surface)) {
    vec3 beyond = lightInMirror(pixel, mirroredDirection(along));
    return room.materials[surface.material].colour.rgb * behind(foam, vec4(beyond, 1.0)).rgb;
  }
  vec3 light = litSurface(pixel, surface, along, false);
  if (isGlossy(surface)) {
    vec4 beyond = vec4(surroundingLight(reflect(along, surface.normal)), 1.0);
    light += fresnel(-dot(along, surface.normal)) * behind(foam, beyond).rgb;
  }
  return light;
}

void main() {
  ivec2 pixel = thisPixel();
  if (!isInImage(pixel)) return;
  vec3 along = normalize(rayOf(pixel));
  Surface surface = surfaceAt(pixel);
  vec3 light = lightOfMeshes(pixel, surface, along);
  imageStore(resultImage, pixel, behind(imageLoad(resultImage, pixel), vec4(light, 1.0)));
}
