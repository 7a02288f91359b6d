// How a trained model's raw parameters become a foam's, and the gradients of that (docs/FOAM.md "Checkpoint model.pt").
#ifndef FROTH_FOAM_ACTIVATIONS_H
#define FROTH_FOAM_ACTIVATIONS_H
#include "prelude.h"

// Softplus with beta 100; beyond 20 / beta torch returns the value itself.
FOAM_FN real softplus(real raw) {
  real scaled = real(100) * raw;
  return scaled > real(20) ? raw : std::log1p(exp(scaled)) / real(100);
}

// The raw value of an activated one [> 0].
FOAM_FN real softplusInverse(real activated) {
  real scaled = real(100) * activated;
  return scaled > real(20) ? activated : log(std::expm1(scaled)) / real(100);
}

FOAM_FN real softplusSlope(real raw) {
  real scaled = real(100) * raw;
  return scaled > real(20) ? real(1) : real(1) / (real(1) + exp(-scaled));
}

// The frame of a quaternion (w, x, y, z) of any length [> 0]: the rows of its matrix are normal, tangent, bitangent.
FOAM_FN void frameOfQuaternion(real4 raw, FOAM_OUT(real3) normal, FOAM_OUT(real3) tangent, FOAM_OUT(real3) bitangent) {
  real4 unit = raw / sqrt(dot(raw, raw));
  real w = unit.x, x = unit.y, y = unit.z, z = unit.w;
  normal = real3(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y));
  tangent = real3(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x));
  bitangent = real3(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y));
}

// By the raw quaternion. torque: in the face frame (clip_face_gradient.h), whose tangent, bitangent and normal are the
// axes j, k and i.
FOAM_FN real4 quaternionGradient(real4 raw, real3 torque) {
  real length = sqrt(dot(raw, raw));
  real scale = real(2) / (length * length);  // of the unit quaternion raw / length, by the raw one
  real i = torque.z, j = torque.x, k = torque.y;
  real w = raw.x, x = raw.y, y = raw.z, z = raw.w;
  return scale * real4(-i * x - j * y - k * z, i * w + j * z - k * y, -i * z + j * w + k * x, i * y - j * x + k * w);
}

#include "postlude.h"
#endif
