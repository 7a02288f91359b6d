// Soft Voronoi weights of a face's detail sites, and the Spherical Voronoi colour of one detail site.
// Source: Govindarajan et al., "Power Foam" (2026); the exponents are those of the published models (foam.md).
#ifndef FROTH_FOAM_APPEARANCE_H
#define FROTH_FOAM_APPEARANCE_H
#include "prelude.h"

// Below this the sum of soft Voronoi weights is held, so that values fade out far from all sites.
FOAM_FN real flooredWeightSum(real sum) { return max(sum, real(1e-20)); }

// A vector along a face's tangent, bitangent and normal, in units of the cell's radius.
FOAM_FN real3 inFaceFrame(real3 vector, real3 tangent, real3 bitangent, real3 normal, real inverseRadius) {
  return real3(dot(vector, tangent), dot(vector, bitangent), dot(vector, normal)) * inverseRadius;
}

// What detailWeight asks of a point, given relative to the site in the face's frame: its place on the face, and the squared
// distance from the face's plane.
FOAM_FN real3 faceQuery(real3 local) { return real3(local.x, local.y, local.z * local.z); }

// exp(-sharpness |x - s|^2 / r^2) for the detail site s = p + r (u t + v b), detail = (u, v). In powers of two, so that a site
// costs two differences, three multiply-adds and an exp2.
FOAM_FN real detailWeight(real3 query, real2 detail, real sharpness) {
  real falloff = sharpness * real(1.4426950408889634);  // log2(e)
  real x = query.x - detail.x;
  real y = query.y - detail.y;
  return exp2(-falloff * (x * x + y * y) - falloff * query.z);
}

// The unit direction in which a detail site is seen, `toSite` from the eye. From the site itself it is seen as from just before the
// face, whose normal points to the empty side.
FOAM_FN real3 directionToSite(real3 toSite, real3 normal) {
  real squared = dot(toSite, toSite);
  return squared > real(0) ? toSite / sqrt(squared) : -normal;
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
  real newLargest = max(largest, exponent);
  real rescale = exp(largest - newLargest);
  real weight = exp(exponent - newLargest);
  weightSum = weightSum * rescale + weight;
  colourSum = colourSum * rescale + weight * colour;
  largest = newLargest;
}

// Display-coded colour of a detail site from its base colour (offset from one half) and its finished lobe sums; weightSum 0:
// it has no lobes.
FOAM_FN real3 lobeColour(real3 base, real weightSum, real3 colourSum) {
  real3 colour = real3(real(0.5)) + base;
  if (weightSum > real(0)) colour = colour + colourSum / weightSum;
  return real3(max(colour.x, real(0)), max(colour.y, real(0)), max(colour.z, real(0)));
}

#include "postlude.h"
#endif
