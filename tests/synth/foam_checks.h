// What holds for every procedural foam.
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include "foam/foam_arrays.h"
#include "tests/same_bits.h"

namespace froth {

inline bool haveSameBits(const Foam& a, const Foam& b) {
  bool isSame = a.cellCount == b.cellCount && a.detailCount == b.detailCount && a.lobeCount == b.lobeCount &&
                a.lobeOffsets == b.lobeOffsets;
  visitArrays([&](const FoamArray&, auto values) { isSame = isSame && haveSameBits(a.*values, b.*values); });
  return isSame;
}

inline bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

inline void expectSound(const Foam& foam) {
  const size_t n = foam.cellCount, nk = n * foam.detailCount;
  const size_t lobes = foam.lobeOffsets.empty() ? nk * foam.lobeCount : foam.lobeOffsets.back();
  ASSERT_GE(n, 1u);
  ASSERT_TRUE(foam.lobeOffsets.empty() || foam.lobeOffsets.size() == nk + 1);
  visitArrays([&](const FoamArray& array, auto values) {
    if (array.canBeEmpty && (foam.*values).empty()) return;
    ASSERT_EQ((foam.*values).size(), array.index == FoamIndex::kCell         ? n
                                     : array.index == FoamIndex::kDetailSite ? nk
                                                                             : lobes)
        << array.name;
  });
  if (testing::Test::HasFatalFailure()) return;
  for (size_t i = 0; i < n; ++i) {
    ASSERT_TRUE(isFinite(foam.sites[i])) << "cell " << i;
    ASSERT_GT(foam.radii[i], 0) << "cell " << i;
    ASSERT_GE(foam.densities[i], 0) << "cell " << i;
    const FaceFrame<double> frame = faceFrame<double>(foam.orientations[i]);
    ASSERT_NEAR(glm::length(frame.normal), 1, 1e-6) << "cell " << i;
    ASSERT_NEAR(glm::dot(frame.normal, frame.tangent), 0, 1e-6) << "cell " << i;
    ASSERT_NEAR(glm::length(glm::cross(frame.normal, frame.tangent) - frame.bitangent), 0, 1e-6) << "cell " << i;
  }
  for (size_t i = 0; i < nk; ++i) {
    ASSERT_LE(glm::length(foam.detailSites[i]), 1.0f) << "detail site " << i;
    ASSERT_LE(std::abs(foam.detailHeights[i]), 1.0f) << "detail site " << i;
  }
  for (size_t i = 0; i < lobes; ++i) {
    ASSERT_TRUE(isFinite(foam.lobeAxes[i]) && isFinite(foam.lobeColours[i])) << "lobe " << i;
  }
}

}  // namespace froth
