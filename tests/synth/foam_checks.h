// What holds for every procedural foam.
#pragma once

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "baker/foam.h"

namespace froth {

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

inline bool sameBytes(const Foam& a, const Foam& b) {
  return a.cellCount == b.cellCount && a.detailCount == b.detailCount && a.lobeCount == b.lobeCount &&
         sameBytes(a.sites, b.sites) && sameBytes(a.radii, b.radii) && sameBytes(a.densities, b.densities) &&
         sameBytes(a.orientations, b.orientations) && sameBytes(a.detailSites, b.detailSites) &&
         sameBytes(a.detailHeights, b.detailHeights) && sameBytes(a.lobeAxes, b.lobeAxes) &&
         sameBytes(a.lobeColours, b.lobeColours);
}

inline bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline void expectSound(const Foam& foam) {
  const size_t n = foam.cellCount, nk = n * foam.detailCount, nkm = nk * foam.lobeCount;
  ASSERT_GE(n, 1u);
  ASSERT_EQ(foam.sites.size(), n);
  ASSERT_EQ(foam.radii.size(), n);
  ASSERT_EQ(foam.densities.size(), n);
  ASSERT_EQ(foam.orientations.size(), n);
  ASSERT_EQ(foam.detailSites.size(), nk);
  ASSERT_EQ(foam.detailHeights.size(), nk);
  ASSERT_EQ(foam.lobeAxes.size(), nkm);
  ASSERT_EQ(foam.lobeColours.size(), nkm);
  for (size_t i = 0; i < n; ++i) {
    ASSERT_TRUE(isFinite(foam.sites[i])) << "cell " << i;
    ASSERT_GT(foam.radii[i], 0) << "cell " << i;
    ASSERT_GE(foam.densities[i], 0) << "cell " << i;
    const FaceFrame<double> frame = faceFrame<double>(foam.orientations[i]);
    ASSERT_NEAR(glm::length(frame.normal), 1, 1e-6) << "cell " << i;
    ASSERT_NEAR(glm::dot(frame.normal, frame.tangent), 0, 1e-6) << "cell " << i;
    ASSERT_NEAR(glm::length(glm::cross(frame.normal, frame.tangent) - frame.bitangent), 0, 1e-6)
        << "cell " << i;
  }
  for (size_t i = 0; i < nk; ++i) {
    ASSERT_LE(glm::length(foam.detailSites[i]), 1.0f) << "detail site " << i;
    ASSERT_LE(std::abs(foam.detailHeights[i]), 1.0f) << "detail site " << i;
  }
  for (size_t i = 0; i < nkm; ++i)
    ASSERT_TRUE(isFinite(foam.lobeAxes[i]) && isFinite(foam.lobeColours[i])) << "lobe " << i;
}

}  // namespace froth
