// What the room's compute passes share: their images, and surfaces of meshes found from depth.
#include "room_layout.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = kBindingFrame, std140) uniform RoomFrameBlock { RoomFrame room; };
layout(set = 0, binding = kBindingDepth) uniform texture2D depthImage;
layout(set = 0, binding = kBindingSurface) uniform texture2D surfaceImage;
layout(set = 0, binding = kBindingMirroredDepth) uniform texture2D mirroredDepthImage;
layout(set = 0, binding = kBindingMirroredSurface) uniform texture2D mirroredSurfaceImage;
layout(set = 0, binding = kBindingShadowMap) uniform texture2D shadowMap;
layout(set = 0, binding = kBindingFoamColour) uniform texture2D foamColourImage;
layout(set = 0, binding = kBindingFoamDistance) uniform texture2D foamDistanceImage;
layout(set = 0, binding = kBindingFoamNormal) uniform texture2D foamNormalImage;
layout(set = 0, binding = kBindingSunlight, rgba16f) uniform restrict image2D sunlightImage;
layout(set = 0, binding = kBindingSurround, rgba16f) uniform restrict image2D surroundImage;
layout(set = 0, binding = kBindingReflection, rgba16f) uniform restrict image2D reflectionImage;
layout(set = 0, binding = kBindingResult, rgba16f) uniform restrict image2D resultImage;

const float kFar = 1e30;  // [metres]

// A point of a mesh; of a mirrored one where it really is.
struct Surface {
  bool isThere;
  vec3 position;
  vec3 normal;     // towards the one who looks
  float distance;  // of the path from the eye, which a mirror may have bent
  uint material;
};

ivec2 thisPixel() { return ivec2(gl_GlobalInvocationID.xy); }
ivec2 pixelWithRay() { return room.counts.z * thisPixel(); }  // of passes with a thread for each pixel that casts rays
bool isInImage(ivec2 pixel) { return all(lessThan(pixel, textureSize(depthImage, 0))); }

// Through the middle of a pixel; its forward component is 1.
vec3 rayOf(ivec2 pixel) {
  vec2 at = vec2(pixel) + 0.5;
  return room.rayCorner.xyz + at.x * room.rayStepX.xyz + at.y * room.rayStepY.xyz;
}

vec3 mirroredPoint(vec3 point) { return point - 2.0 * (dot(room.mirror.xyz, point) + room.mirror.w) * room.mirror.xyz; }
vec3 mirroredDirection(vec3 direction) { return direction - 2.0 * dot(room.mirror.xyz, direction) * room.mirror.xyz; }

Surface surfaceFrom(vec3 ray, float depth, vec4 packed) {
  Surface surface = Surface(depth > 0.0, vec3(0.0), vec3(0.0), kFar, 0u);
  if (!surface.isThere) return surface;
  surface.position = room.numbers.x / depth * ray;
  surface.distance = length(surface.position);
  surface.normal = normalize(packed.xyz);
  surface.material = uint(packed.w);
  return surface;
}

Surface surfaceAt(ivec2 pixel) {
  Surface surface = surfaceFrom(rayOf(pixel), texelFetch(depthImage, pixel, 0).x, texelFetch(surfaceImage, pixel, 0));
  if (dot(surface.normal, surface.position) > 0.0) surface.normal = -surface.normal;
  return surface;
}

// What the mirror shows at a pixel. The mirrored camera drew the room turned over, normals as they are.
Surface mirroredSurfaceAt(ivec2 pixel) {
  Surface surface =
      surfaceFrom(rayOf(pixel), texelFetch(mirroredDepthImage, pixel, 0).x, texelFetch(mirroredSurfaceImage, pixel, 0));
  if (!surface.isThere) return surface;
  vec3 along = mirroredDirection(surface.position);
  surface.position = mirroredPoint(surface.position);
  if (dot(surface.normal, along) > 0.0) surface.normal = -surface.normal;
  return surface;
}

bool isMirror(Surface surface) {
  return surface.isThere && uint(room.materials[surface.material].looks.w) == kMirror;
}
bool isGlossy(Surface surface) {
  return surface.isThere && uint(room.materials[surface.material].looks.w) == kGlossy;
}

bool isSameSurface(Surface a, Surface b) {
  const float kSamePlane = 0.02;  // [metres]
  return a.isThere && b.isThere && isMirror(a) == isMirror(b) && dot(a.normal, b.normal) > 0.9 &&
         abs(dot(b.position - a.position, a.normal)) < kSamePlane;
}

// The surface that takes light for a pixel: a mirror shows another.
struct Shown {
  Surface surface;
  bool isInMirror;
};

// direct: surfaceAt(pixel).
Shown shownBy(Surface direct, ivec2 pixel) {
  return isMirror(direct) ? Shown(mirroredSurfaceAt(pixel), true) : Shown(direct, false);
}

Shown shownAt(ivec2 pixel) { return shownBy(surfaceAt(pixel), pixel); }

bool showsSame(Shown a, Shown b) { return a.isInMirror == b.isInMirror && isSameSurface(a.surface, b.surface); }

// As images hold a share of light: of surfaces seen directly, and in the mirror.
vec4 shareOf(Shown shown, float share) { return shown.isInMirror ? vec4(0.0, share, 0.0, 0.0) : vec4(share, 0.0, 0.0, 0.0); }

// One premultiplied colour behind another.
vec4 behind(vec4 front, vec4 back) { return front + (1.0 - front.w) * back; }

// Light from all around, and what is seen where nothing stands.
vec3 surroundingLight(vec3 direction) { return mix(room.ground.rgb, room.sky.rgb, 0.5 + 0.5 * direction.y); }

// Share of the sun that meshes let through to a point [0..1]: four texels of the shadow map, interpolated.
float sunPastMeshes(vec3 position, vec3 normal) {
  vec3 lifted = position + (1.5 * room.toSun.w) * (dot(normal, room.toSun.xyz) > 0.0 ? normal : -normal);
  vec3 place = (room.shadowFromRelative * vec4(lifted, 1.0)).xyz;
  ivec2 size = textureSize(shadowMap, 0);
  vec2 at = (0.5 * place.xy + 0.5) * vec2(size) - 0.5;
  ivec2 corner = ivec2(floor(at));
  vec2 share = at - vec2(corner);
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 texel = clamp(corner + step, ivec2(0), size - 1);
    vec2 weights = mix(1.0 - share, share, vec2(step));
    lit += weights.x * weights.y * float(texelFetch(shadowMap, texel, 0).x >= place.z);
  }
  return lit;
}
