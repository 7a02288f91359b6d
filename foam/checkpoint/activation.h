// The activations that turn a checkpoint's raw parameters into a foam's, and back (docs/FOAM.md "Checkpoint").
#pragma once

#include <glm/glm.hpp>

namespace froth {

// Softplus with beta 100: log(1 + exp(beta x)) / beta, and x itself where beta x > 20. NaN gives NaN.
double softplus(double raw);

// The float whose softplus, rounded to float, is `activated` [>= 0, finite]; where float32 has none (below
// about 0.003 its steps in the exponent are too coarse), the one that comes nearest: within 50 |raw| units in
// the last place. 0 gives a raw value deep enough to come back as exactly 0.
float inverseSoftplus(float activated);

// Unit quaternion, rounded once to float. One that is a unit quaternion already, up to the rounding of its
// components, is returned as it is, so that writing and reading a foam changes no bit. Needs a length > 0.
glm::vec4 normaliseQuaternion(const glm::dvec4& quaternion);

}  // namespace froth
