// What the gallery is made of.
#pragma once

#include "baker/synth/analytic_scene.h"

namespace froth {

Material floorMaterial();
Material wallMaterial();     // panelling below, embossed plaster above
Material ceilingMaterial();  // coffers
Material landscapeMaterial();
Material marbleMaterial(const glm::dvec3& tint);
Material woodMaterial();
Material columnMaterial(double radius);  // fluted
Material plainMaterial(const glm::dvec3& albedo);
Material lacquerMaterial(const glm::dvec3& albedo, double roughness);
Material metalMaterial(const glm::dvec3& reflectance, double roughness);
Material bandedCeramicMaterial(double radius);
Material spiralBallMaterial(double radius);

// A picture on the face of a box of this half-extent (x: half width, y: half height of the whole, with
// frame).
enum class Painting { kBubbles, kSunset, kCircles, kWeave, kMarbling };
Material pictureMaterial(Painting painting, const glm::dvec2& halfExtent, uint32_t wallAxis);

}  // namespace froth
