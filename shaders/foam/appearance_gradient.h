// Gradients of appearance.h, for training: soft Voronoi blends and Spherical Voronoi lobes.
#ifndef FROTH_FOAM_APPEARANCE_GRADIENT_H
#define FROTH_FOAM_APPEARANCE_GRADIENT_H
#include "prelude.h"

// Of a blend sum_k w_k y_k / S, S = max(sum_k w_k, floor): the gradient by the exponent of w_k. share = w_k / S;
// seedOwn and seedBlend: the seed times y_k and times the blend. Below the floor S does not move.
FOAM_FN real exponentGradient(real share, real seedOwn, real seedBlend, bool isFloored) {
  return share * (isFloored ? seedOwn : seedOwn - seedBlend);
}

// By the place (u, v) of a detail site. The point of the query, in the face frame [radii], moves the other way:
// minus the sum over all detail sites, and minus 2 sharpness z times the sum of exponentGradients along the normal.
FOAM_FN real2 placeGradient(real3 point, real2 place, real sharpness, real exponentSeed) {
  real scale = real(2) * sharpness * exponentSeed;
  return real2(scale * (point.x - place.x), scale * (point.y - place.y));
}

// Of lobeExponent. Where a lobe looks straight at the eye its exponent has a kink, and no gradient.
FOAM_FN void lobeGradient(real3 axis, real3 direction, real seed, FOAM_OUT(real3) axisGradient,
                          FOAM_OUT(real3) directionGradient) {
  axisGradient = real3(real(0));
  directionGradient = real3(real(0));
  real temperature = sqrt(dot(axis, axis));
  if (!(temperature > real(0))) return;
  real3 unit = axis / temperature;
  real3 difference = direction - unit;
  real distance = sqrt(dot(difference, difference));
  if (distance < real(1e-6)) return;
  real scaled = seed / distance;
  axisGradient = scaled * (direction - (real(2) - dot(direction, unit)) * unit);
  directionGradient = (-scaled * temperature) * difference;
}

// Of directionToDetail, by the place of the detail site.
FOAM_FN real3 detailDirectionGradient(real3 toDetail, real3 direction, real3 seed) {
  real squared = dot(toDetail, toDetail);
  if (!(squared > real(0))) return real3(real(0));
  return (seed - dot(direction, seed) * direction) / sqrt(squared);
}

// lobeColour holds a channel at 0 and at the largest half: there it has no gradient.
FOAM_FN real shownGradient(real shown, real seed) { return shown > real(0) && shown < real(65504) ? seed : real(0); }

#include "postlude.h"
#endif
