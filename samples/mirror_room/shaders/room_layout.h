// What crosses the border between the room's C++ and its shaders: one text for both.
//
// Vectors are in the world's axes, positions relative to the camera's eye: the world may lie far from its origin.
#ifndef FROTH_ROOM_LAYOUT_H
#define FROTH_ROOM_LAYOUT_H

#if defined(__cplusplus)
#include <cstdint>
#include <glm/glm.hpp>
namespace froth::room {
using glm::ivec4;
using glm::mat4;
using glm::vec4;
using uint = uint32_t;
#define ROOM_CONST constexpr uint
#else
#define ROOM_CONST const uint
#endif

ROOM_CONST kMostMaterials = 16;
ROOM_CONST kMostParticles = 24;
ROOM_CONST kSurroundRays = 8;  // of ambient occlusion, per surface point

// RoomMaterial::looks.w
ROOM_CONST kMatt = 0;
ROOM_CONST kGlossy = 1;
ROOM_CONST kMirror = 2;

// Bindings of set 0 of all compute passes. Storage images: no more than the four that every device has.
ROOM_CONST kBindingFrame = 0;
ROOM_CONST kBindingDepth = 1;          // device depth of the meshes, reversed, 0: none
ROOM_CONST kBindingSurface = 2;        // xyz normal, w material
ROOM_CONST kBindingMirroredDepth = 3;  // the same of the mirrored camera; what is behind the mirror left out
ROOM_CONST kBindingMirroredSurface = 4;
ROOM_CONST kBindingShadowMap = 5;  // of the meshes
ROOM_CONST kBindingFoamColour = 6;
ROOM_CONST kBindingFoamDistance = 7;
ROOM_CONST kBindingFoamNormal = 8;
ROOM_CONST kBindingSunlight = 9;     // share of the sun that reaches a mesh: x seen directly, y in the mirror
ROOM_CONST kBindingSurround = 10;    // the same of the surrounding light: ambient occlusion by the foam
ROOM_CONST kBindingReflection = 11;  // foam and particles that a mirror or a glossy mesh shows, premultiplied
ROOM_CONST kBindingResult = 12;      // linear light; first that of foam and motes before the meshes, premultiplied

struct RoomMaterial {
  vec4 colour;  // w: roughness
  vec4 looks;   // w: kMatt, kGlossy or kMirror
};

struct RoomParticle {
  vec4 place;   // centre, w: radius
  vec4 colour;  // linear light, w: opacity in the middle
};

// std140
struct RoomFrame {
  mat4 shadowFromRelative;  // clip space of the shadow map from positions
  // Through pixel (x, y) goes the ray corner + x stepX + y stepY, whose forward component is 1; the centre of the first
  // pixel is (0.5, 0.5).
  vec4 rayCorner, rayStepX, rayStepY;
  vec4 mirror;       // the plane dot(xyz, position) + w = 0, xyz unit and on the side that it shows
  vec4 toSun;        // w: size of a texel of the shadow map [metres]
  vec4 sun;          // light on a surface that faces it
  vec4 sky, ground;  // surrounding light from above and from below
  // x: depth at distance 1 forward, y: reach of ambient occlusion [metres], z: how much of their shadow meshes cast on
  // the foam, w: unused
  vec4 numbers;
  // particles, 1: the walk set is there, pixels from one with rays to the next, 1: reflections show base colours
  ivec4 counts;
  RoomMaterial materials[kMostMaterials];
  RoomParticle particles[kMostParticles];
};

#if defined(__cplusplus)
#undef ROOM_CONST
}  // namespace froth::room
#endif
#endif
