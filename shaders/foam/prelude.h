// Maps the few words in which the foam's mathematics is written onto GLSL, C++ and CUDA.
//
// C++ and CUDA: every function is a template over `real` (float or double); vectors are GLM's.
// GLSL: `real` is float. Undone by postlude.h, so that no macro leaks out of the foam's headers.
#if defined(__cplusplus)

#include <cmath>
#include <glm/glm.hpp>

#if defined(__CUDACC__)
#define FOAM_FN         \
  template <class real> \
  __host__ __device__ inline
#else
#define FOAM_FN         \
  template <class real> \
  inline
#endif
#define FOAM_OUT(type) type&
#define FOAM_INOUT(type) type&
#define real2 glm::vec<2, real>
#define real3 glm::vec<3, real>
#define real4 glm::vec<4, real>
#define FOAM_PRECISE

namespace froth::foam {
using glm::cross;
using glm::dot;
using std::abs;
using std::cos;
using std::exp;
using std::exp2;
using std::fma;
using std::log;
using std::max;
using std::min;
using std::pow;
using std::sin;
using std::sqrt;
using std::tan;

#else

#define FOAM_FN
#define FOAM_OUT(type) out type
#define FOAM_INOUT(type) inout type
#define real float
#define real2 vec2
#define real3 vec3
#define real4 vec4
#define FOAM_PRECISE precise

#endif
