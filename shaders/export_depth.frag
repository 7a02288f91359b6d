// Device depth from an image into a depth attachment. The depth test leaves what is nearer.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(set = 0, binding = 0) uniform texture2D depth;

void main() { gl_FragDepth = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).x; }
