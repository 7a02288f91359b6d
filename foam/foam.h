// The foam as every stage of the baker sees it: activated parameters, one flat struct of arrays.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

// Arrays are indexed by cell, then detail site, then lobe. Lengths follow from the three counts.
struct Foam {
  uint32_t cellCount = 0;    // N >= 1
  uint32_t detailCount = 0;  // K, detail sites per cell [1..32]
  uint32_t lobeCount = 0;    // M, Spherical Voronoi lobes per detail site [0..32]; with lobeOffsets: most of them

  std::vector<glm::vec3> sites;         // [N] p_i [scene units]
  std::vector<float> radii;             // [N] r_i [scene units, > 0]
  std::vector<float> densities;         // [N] sigma_i [1 / scene unit, >= 0]
  std::vector<glm::vec4> orientations;  // [N] unit quaternion (w, x, y, z); rows of its matrix are n, t, b
  std::vector<glm::vec2> detailSites;   // [N*K] (u, v) in units of r_i along (t, b)
  std::vector<float> detailHeights;     // [N*K] displacement in units of r_i
  std::vector<glm::vec3> lobeAxes;      // [N*K*M] a: direction times temperature
  std::vector<glm::vec3> lobeColours;   // [N*K*M] c: offset from one half, or from the base colour

  // Of a compressed foam; a trained one has neither.
  std::vector<glm::vec3> baseColours;  // [N*K] offset from one half; empty: all zero
  // [N*K+1] lobes of detail site s: [lobeOffsets[s], lobeOffsets[s+1]); empty: M each
  std::vector<uint64_t> lobeOffsets;
};

// A range of a foam's lobe arrays.
struct LobeRange {
  uint64_t first = 0;
  uint32_t count = 0;
};

// The lobes of detail site `detail` = cell * K + k.
inline LobeRange lobesOf(const Foam& foam, uint64_t detail) {
  if (foam.lobeOffsets.empty()) return {detail * foam.lobeCount, foam.lobeCount};
  return {foam.lobeOffsets[detail], static_cast<uint32_t>(foam.lobeOffsets[detail + 1] - foam.lobeOffsets[detail])};
}

// Rows n (face normal), t, b of the rotation matrix of a unit quaternion (w, x, y, z).
template <class Real>
struct FaceFrame {
  glm::vec<3, Real> normal, tangent, bitangent;
};

template <class Real>
FaceFrame<Real> faceFrame(const glm::vec4& orientation) {
  const Real w = orientation.x, x = orientation.y, y = orientation.z, z = orientation.w;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
}

}  // namespace froth
