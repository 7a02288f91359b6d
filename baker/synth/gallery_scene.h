// The gallery: a room with a window, pictures, sculptures; metres, z up, the window in the wall x = 0.
#pragma once

#include <glm/glm.hpp>

#include "baker/synth/analytic_scene.h"

namespace froth {

// The room spans [0, size] on each axis.
inline constexpr glm::dvec3 kRoomSize{8.0, 6.0, 3.3};
inline constexpr double kWallDepth = 0.3;  // of the window's reveal
// Window: y and z ranges in the wall x = 0.
inline constexpr glm::dvec2 kWindowLow{1.7, 0.85}, kWindowHigh{4.3, 2.65};
inline constexpr double kWindowBar = 0.045;  // thickness of the glazing bars
inline constexpr double kSkyRadius = 30.0;   // of the landscape's backdrop
inline constexpr glm::dvec3 kSkyCentre{0.0, 3.0, 1.6};

const AnalyticScene& galleryScene();

// Lights the point of `solid` nearest to x (which should lie on its embossed surface).
LitPoint lightPoint(const Solid& solid, const glm::dvec3& x);

// Display-coded colour [0..1] of a lit point seen along `direction` (unit, towards the point).
glm::dvec3 displayColour(const LitPoint& point, const glm::dvec3& direction);

}  // namespace froth
