// The lattices on which the values of a quantized asset lie. The baker snaps a foam to them before anything is built on
// its numbers; from there on values are ordinary floats, and the writer stores their lattice indices without loss.
//
// Every step between lattice points is a power of two and every formula uses + - * / sqrt alone, so that all readers
// get the same floats.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/glm.hpp>

namespace froth {

struct Quantization {
  // [scene units] one grid for the scene: world position = step * integer; 0: float32 as it is
  double positionStep = 0;
  uint32_t radiusBits = 23;   // bits kept of a radius' mantissa [1..23]
  uint32_t densityBits = 23;  // bits kept of a density's mantissa [1..23]
  uint32_t normalBits = 0;    // bits per axis of the octahedral normal [4..15]; 0: quaternions of floats
  float detailSiteStep = 0;   // [radius] 0: float32 as it is, as below
  float heightStep = 0;       // [radius] of cell and detail heights
  float colourStep = 0;       // [display-coded] of base and lobe colours, times 2^colourScale of the cell
  float lobeAxisStep = 0;     // of lobe axes, or of what they differ by from the codebook's
};

// The nearest float with `bits` bits of mantissa behind the leading one; ties to even. value >= 0, finite.
float roundMantissa(float value, uint32_t bits);
// The largest such float <= value.
float floorMantissa(float value, uint32_t bits);

// The nearest multiple of step (a power of two); ties to even. step 0: the value.
float snapToStep(float value, float step);
double snapToStep(double value, double step);

// The largest power of two of which all values are multiples, by at most kMaxLatticeIndex (format/lattice.h); 0: there
// is none.
float commonStep(std::span<const float> values);

// Octahedral map (Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014):
// index pair [0 .. 2^bits - 2] of a unit normal, and back to the unit quaternion (w, x, y, z) whose matrix has the
// normal as its first row. A normal alone leaves the rotation about it open; this one is the shortest from the nearer
// of +x and -x.
std::array<uint32_t, 2> normalIndices(glm::dvec3 normal, uint32_t bits);
glm::vec4 orientationOfNormal(std::array<uint32_t, 2> indices, uint32_t bits);
// The indices of which `orientation` is the orientationOfNormal(), bit for bit; none: it lies off the lattice.
std::optional<std::array<uint32_t, 2>> findNormalIndices(const glm::vec4& orientation, uint32_t bits);

}  // namespace froth
