#version 460
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

layout(push_constant) uniform Part {
  mat4 clipFromNode;
  vec4 clipPlane;    // in the node's frame: what is behind it is left out
  vec4 rotation;     // quaternion (x, y, z, w), world from node
  float material;
} part;

layout(location = 0) out vec3 worldNormal;
layout(location = 1) out float beforePlane;

void main() {
  gl_Position = part.clipFromNode * vec4(position, 1.0);
  vec3 turn = 2.0 * cross(part.rotation.xyz, normal);
  worldNormal = normal + part.rotation.w * turn + cross(part.rotation.xyz, turn);
  beforePlane = dot(part.clipPlane, vec4(position, 1.0));
}
