// Soft Voronoi weights of a face's detail sites, and the Spherical Voronoi colour of one detail site.
// Source: Govindarajan et al., "Power Foam" (2026); the exponents are those of the published models (docs/FOAM.md).
#ifndef FROTH_FOAM_APPEARANCE_H
#define FROTH_FOAM_APPEARANCE_H
#include "prelude.h"

// Below this the sum of soft Voronoi weights is held, so that values fade out far from all sites.
FOAM_FN real flooredWeightSum(real sum) { return max(sum, real(1e-20)); }

// A vector along a face's tangent, bitangent and normal, in units of the cell's radius.
FOAM_FN real3 inFaceFrame(real3 vector, real3 tangent, real3 bitangent, real3 normal, real inverseRadius) {
  return real3(dot(vector, tangent), dot(vector, bitangent), dot(vector, normal)) * inverseRadius;
}

// What detailWeight asks of a point, given relative to the site in the face's frame [radii]: its place on the face, and
// the squared distance from the face's plane. Held where squares are finite, far beyond where weights vanish.
FOAM_FN real3 faceQuery(real3 local) {
  real farthest = real(1e9);
  real x = min(max(local.x, -farthest), farthest);
  real y = min(max(local.y, -farthest), farthest);
  real z = min(max(local.z, -farthest), farthest);
  return real3(x, y, z * z);
}

// exp(-sharpness |x - s|^2 / r^2) for the detail site s = p + r (u t + v b), detail = (u, v). In powers of two, so that
// a site costs two differences, three multiply-adds and an exp2.
FOAM_FN real detailWeight(real3 query, real2 detail, real sharpness) {
  // log2(e); finite: at the site itself 0 * infinity is NaN
  real falloff = min(sharpness, real(1e30)) * real(1.4426950408889634);
  real x = query.x - detail.x;
  real y = query.y - detail.y;
  return exp2(-falloff * (x * x + y * y) - falloff * query.z);
}

// A detail site with less than this part of all weights is not looked up for the colour of a ray that is cast by
// itself: the error is below half an 8-bit step (docs/STABILITY.md).
FOAM_FN real leastShownShare() { return real(1) / real(1024); }

// The unit direction in which a detail site is seen, `toDetail` from the eye. From the site itself it is seen as from
// just before the face, whose normal points to the empty side.
FOAM_FN real3 directionToDetail(real3 toDetail, real3 normal) {
  real squared = dot(toDetail, toDetail);
  return squared > real(0) ? toDetail / sqrt(squared) : -normal;
}

// Exponent of one lobe seen along `direction` (unit): -tau |direction - axis/tau|, tau = |axis|.
FOAM_FN real lobeExponent(real3 axis, real3 direction) {
  real temperature = sqrt(dot(axis, axis));
  if (!(temperature > real(0))) return real(0);
  real3 difference = direction - axis / temperature;
  return -temperature * sqrt(dot(difference, difference));
}

// Adds one lobe to a running, normalised sum that never underflows: weights are kept relative to the largest so far.
// Start with largest = the lowest finite number, weightSum = 0, colourSum = 0.
FOAM_FN void addLobe(real exponent, real3 colour, FOAM_INOUT(real) largest, FOAM_INOUT(real) weightSum,
                     FOAM_INOUT(real3) colourSum) {
  bool isLarger = exponent > largest;
  real smaller = exp(isLarger ? largest - exponent : exponent - largest);  // of the two weights; the other is 1
  real rescale = isLarger ? smaller : real(1);
  real weight = isLarger ? real(1) : smaller;
  weightSum = weightSum * rescale + weight;
  colourSum = colourSum * rescale + weight * colour;
  largest = isLarger ? exponent : largest;
}

// From 0 to the largest half, 65504, as which renderers keep it between passes (1 is white). Sums that left the floats
// give 0.
FOAM_FN real shownColour(real value) { return value > real(0) ? min(value, real(65504)) : real(0); }

// Display-coded colour of a detail site from its base colour (offset from one half) and its finished lobe sums;
// weightSum 0:
// it has no lobes.
FOAM_FN real3 lobeColour(real3 base, real weightSum, real3 colourSum) {
  real3 colour = real3(real(0.5)) + base;
  if (weightSum > real(0)) colour = colour + colourSum / weightSum;
  return real3(shownColour(colour.x), shownColour(colour.y), shownColour(colour.z));
}

#include "postlude.h"
#endif
