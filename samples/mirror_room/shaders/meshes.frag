#version 460
layout(location = 0) in vec3 worldNormal;
layout(location = 1) in float beforePlane;

layout(push_constant) uniform Part {
  mat4 clipFromNode;
  vec4 clipPlane;
  vec4 rotation;
  float material;
} part;

layout(location = 0) out vec4 surface;

void main() {
  if (beforePlane <= 0.0) discard;
  surface = vec4(normalize(worldNormal), part.material);
}
