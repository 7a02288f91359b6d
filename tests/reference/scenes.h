// Small foams and views for the tests of the reference renderer.
#pragma once

#include <cstdint>

#include "foam/foam.h"
#include "reference/camera/camera.h"
#include "reference/render/reference.h"

namespace froth {

// A cell of one detail site and one lobe: one colour from everywhere.
struct PlainCell {
  glm::vec3 site;
  float radius = 1;
  float density = 1;
  glm::vec3 colour = {0.5f, 0.5f, 0.5f};
  glm::vec4 orientation = {1, 0, 0, 0};  // the face's normal is +x
  float height = 5;                      // in radii; 5: the face lies outside the ball, which is solid throughout
};

inline constexpr glm::vec4 kFaceTowardsMinusZ = {0.70710678f, 0, -0.70710678f, 0};
inline constexpr glm::vec4 kFaceTowardsPlusZ = {0.70710678f, 0, 0.70710678f, 0};

Foam foamOf(const std::vector<PlainCell>& cells);

// Overlapping cells in the cube -1..1 with faces, reliefs and lobes at random; every tenth has no density.
// Sites lie on multiples of 1/16, so that they can be moved by 10^6 in float without rounding.
Foam randomFoam(uint32_t cellCount, uint32_t detailCount, uint32_t lobeCount, uint64_t seed);

// Cell k of the result is cell order[k].
Foam permuteFoam(const Foam& foam, const std::vector<uint32_t>& order);

// Square pixels, a field of view of 2 atan(tanHalfFov) across the height. Sites must not lie straight above
// the eye.
View lookAt(const glm::dvec3& eye, const glm::dvec3& target, uint32_t width, uint32_t height, double tanHalfFov);

// The unit direction of a pixel, and the eye.
glm::dvec3 directionOf(const View& view, uint32_t x, uint32_t y);

// Near tests off.
ReferenceOptions plainOptions(Precision precision = Precision::kDouble);

// Renders, and fails the test when that fails.
RenderedImages renderFoam(const Foam& foam, const View& view, const ReferenceOptions& options = plainOptions());

// All four images have the same bits.
void expectSameImages(const RenderedImages& a, const RenderedImages& b);

}  // namespace froth
