// Cones around bundles of rays through one origin: which balls the rays of any lens can meet.
//
// A cone is (axis, sine of its half angle), a half angle of up to 60 degrees. kConeOfAll: every direction; kConeOfNone:
// no ray. Everything here errs to the side of a wider cone.
#ifndef FROTH_FOAM_CONES_H
#define FROTH_FOAM_CONES_H
#include "prelude.h"

// In place of the sine.
const int kConeOfAll = 2;
const int kConeOfNone = -1;

// Wider by what float may have rounded off.
FOAM_FN real4 guardedCone(real3 axis, real sine) {
  real wider = sine * real(1.001) + real(2e-6);
  return real4(axis.x, axis.y, axis.z, wider < real(0.866) ? wider : real(kConeOfAll));
}

// Around directions whose unit vectors lie at most `chord` from that of the axis.
FOAM_FN real4 coneOfChord(real3 axis, real chord) {
  if (!(chord < real(1))) return real4(axis.x, axis.y, axis.z, real(kConeOfAll));
  return guardedCone(axis, chord * sqrt(real(1) - real(0.25) * chord * chord));
}

// The sine of the half angle that a cone around `axis` needs to hold another cone; kConeOfAll: more than such a cone
// has.
FOAM_FN real sineToHold(real3 axis, real4 cone) {
  if (cone.w < real(0)) return real(0);
  real3 difference = real3(cone.x, cone.y, cone.z) - axis;
  real squaredChord = dot(difference, difference);
  if (cone.w > real(1) || !(squaredChord < real(1))) return real(kConeOfAll);
  real sine = sqrt(squaredChord * (real(1) - real(0.25) * squaredChord));
  real cosine = real(1) - real(0.5) * squaredChord;
  real coneCosine = sqrt(real(1) - cone.w * cone.w);
  if (cosine * coneCosine - sine * cone.w < real(0.5)) return real(kConeOfAll);
  return sine * coneCosine + cosine * cone.w;
}

// Whether a ray of the cone can meet the ball, of a guardedRadius(); true for balls that hold the origin, unless there
// is no ray.
FOAM_FN bool coneMeetsBall(real4 cone, real3 centre, real radius) {
  if (cone.w < real(0)) return false;
  real squaredDistance = dot(centre, centre);
  if (cone.w > real(1) || squaredDistance <= radius * radius) return true;
  real3 axis = real3(cone.x, cone.y, cone.z);
  real along = dot(centre, axis);
  real3 perpendicular = centre - axis * along;
  real across = sqrt(dot(perpendicular, perpendicular));
  real cosine = sqrt(real(1) - cone.w * cone.w);
  // Distance from the nearest ray of the cone's border, and along it; inside the cone the distance is negative.
  return across * cosine - along * cone.w <= radius && along * cosine + across * cone.w > real(0);
}

#include "postlude.h"
#endif
