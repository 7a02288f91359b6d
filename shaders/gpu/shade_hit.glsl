// What one ray gathers in one visible cell, once its interval in the bounded cell is known (foam.md "What one ray meets
// in one cell", steps 3 to 7). The same text for the raster and the walk.
#ifndef FROTH_GPU_SHADE_HIT_GLSL
#define FROTH_GPU_SHADE_HIT_GLSL
#include "gpu/frame.glsl"
#include "gpu/work.glsl"
#include "foam/appearance.h"
#include "foam/cell.h"
#include "foam/compositing.h"

layout(constant_id = kConstantDetailCount) const uint detailCount = 8;
layout(constant_id = kConstantHasHeights) const bool hasHeights = true;

struct Radiance {
  vec3 colour;  // display-coded, premultiplied
  float logTransmittance;
  vec3 normal;
  float distance;  // kInfinity until transmittance falls below the quantile
};

Radiance emptyRadiance() { return Radiance(vec3(0.0), 0.0, vec3(0.0), kInfinity); }

bool isSaturated(Radiance radiance) { return radiance.logTransmittance < FRAME.logCutoff; }

// Height of the displaced face at a query point, in units of the radius.
float heightAt(uint firstSite, vec3 query) {
  float term = queryTerm(query, FRAME.detailSharpness);
  float weightSum = 0.0;
  float heightSum = 0.0;
  for (uint k = 0; k < detailCount; ++k) {
    vec4 site = FRAME.sites.v[firstSite + 2 * k];
    float weight = detailWeightOfTerms(query, term, site.xyz);
    weightSum += weight;
    heightSum += weight * site.w;
  }
  return heightSum / flooredWeightSum(weightSum);
}

vec3 colourAt(uint firstSite, vec3 query) {
  float term = queryTerm(query, FRAME.detailSharpness);
  float weightSum = 0.0;
  vec3 colourSum = vec3(0.0);
  for (uint k = 0; k < detailCount; ++k) {
    float weight = detailWeightOfTerms(query, term, FRAME.sites.v[firstSite + 2 * k].xyz);
    weightSum += weight;
    colourSum += weight * FRAME.sites.v[firstSite + 2 * k + 1].xyz;
  }
  return colourSum / flooredWeightSum(weightSum);
}

void shadeHit(uint visible, CellRecord cell, vec3 direction, float tNear, float tFar, inout Radiance radiance) {
  vec3 centre = cell.ball.xyz;
  float facing = dot(cell.face.xyz, direction);
  bool isInsideFirst = facing >= 0.0;
  uint firstSite = visible * detailCount * 2;

  float height = 0.0;
  if (hasHeights) {
    float tBase = intersectFace(centre, cell.face.xyz, facing, 0.0);
    float tQuery = isInsideFirst ? tNear : max(tNear, tBase);
    vec3 query = faceQuery(tQuery * direction - centre, cell.tangent.xyz, cell.bitangent.xyz, cell.tangent.w);
    countWork(kWorkHeights, 1);
    height = heightAt(firstSite, query) * cell.ball.w;
  }
  float tFace = intersectFace(centre, cell.face.xyz, facing, height);
  if (isInsideFirst) tFar = min(tFar, tFace);
  else tNear = max(tNear, tFace);
  if (!(tFar > tNear)) return;

  vec3 query = faceQuery(tNear * direction - centre, cell.tangent.xyz, cell.bitangent.xyz, cell.tangent.w);
  float opticalDepth = cell.face.w * (tFar - tNear);
  float weight = exp(radiance.logTransmittance) * opacity(opticalDepth);
  countWork(kWorkColours, 1);
  radiance.colour += weight * colourAt(firstSite, query);
  radiance.normal += weight * cell.face.xyz;
  float after = radiance.logTransmittance - opticalDepth;
  if (radiance.logTransmittance >= FRAME.logQuantile && after < FRAME.logQuantile) {
    radiance.distance = quantileDistance(tNear, radiance.logTransmittance, FRAME.logQuantile, cell.face.w);
  }
  radiance.logTransmittance = after;
}

#endif
