// Directions over a hemisphere, spread so that each stands for the same share of a surface's light.
const float kGoldenAngle = 2.39996323;

// Every block of 4 x 4 pixels, wherever it begins, holds each of 0 ... 15 once.
uint placeInBlock(ivec2 pixel) { return uint(pixel.x & 3) * 4u + uint(pixel.y & 3); }

// Direction `i` of `count` around a unit normal: points of a Fibonacci spiral on the disc, lifted onto the hemisphere.
vec3 spreadDirection(vec3 normal, uint i, uint count) {
  float squaredRadius = (float(i) + 0.5) / float(count);
  float angle = kGoldenAngle * float(i);
  // Duff et al., "Building an Orthonormal Basis, Revisited" (2017).
  float side = normal.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (side + normal.z);
  float b = normal.x * normal.y * a;
  vec3 tangent = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
  vec3 bitangent = vec3(b, side + normal.y * normal.y * a, -normal.y);
  float radius = sqrt(squaredRadius);
  return radius * cos(angle) * tangent + radius * sin(angle) * bitangent + sqrt(1.0 - squaredRadius) * normal;
}
