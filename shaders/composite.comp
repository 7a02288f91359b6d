// The foam's colour over the engine's, both premultiplied. FROTH_TARGET_FORMAT is the engine's.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_buffer_reference : require
#include "gpu/layout.h"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

layout(push_constant) uniform Push { CompositeConstants v; } push;

layout(set = 0, binding = 0, FROTH_TARGET_FORMAT) uniform image2D target;
layout(set = 0, binding = 1) uniform texture2D foam;
layout(set = 0, binding = 2) uniform texture2D shadowFactor;

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= push.v.width || pixel.y >= push.v.height) return;
  ivec2 place = ivec2(pixel + uvec2(push.v.x, push.v.y));
  vec4 colour = texelFetch(foam, place, 0);
  if (push.v.hasShadow != 0) colour.rgb *= texelFetch(shadowFactor, place, 0).x;
  imageStore(target, place, colour + (1.0 - colour.a) * imageLoad(target, place));
}
