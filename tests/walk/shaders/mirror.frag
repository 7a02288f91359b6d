// An engine's fragment shader, of a triangle that covers the picture: the ray of each pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "clashes.glsl"
#define FROTH_WALK_SET 0
#define FROTH_WALK_NO_COUNTERS
#define FROTH_WALK_STREAMS 1
#include "froth_walk.glsl"

layout(location = 0) out vec4 colour;
layout(push_constant) uniform Push {
  vec4 corner, alongX, alongY;  // direction of pixel (x, y): corner + x alongX + y alongY
} push;

void main() {
  vec3 direction = push.corner.xyz + gl_FragCoord.x * push.alongX.xyz + gl_FragCoord.y * push.alongY.xyz;
  FrothHit hit;
  colour = frothRadiance(frothRay(vec3(0.0), normalize(direction)), hit);
}
