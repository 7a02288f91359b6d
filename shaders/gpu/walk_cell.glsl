// What one ray meets in one cell, from the cell's bits (docs/FOAM.md "What one ray meets in one cell").
#ifndef FROTH_GPU_WALK_CELL_GLSL
#define FROTH_GPU_WALK_CELL_GLSL
#include "gpu/detail_colour.glsl"
#include "foam/cell.h"
#include "foam/clip_face.h"

// A ray in the axes and units of the instance at hand.
struct LocalRay {
  vec3 origin;  // relative to the eye
  vec3 direction;
};

// A live cell that a ray meets, and its face.
struct MetCell {
  uvec2 cell;
  vec3 centre;  // as seen from the ray's origin
  float radius;
};

vec3 faceQueryAt(MetCell met, Frame frame, vec3 direction, float t) {
  return faceQuery(
      inFaceFrame(t * direction - met.centre, frame.tangent, frame.bitangent, frame.normal, 1.0 / met.radius));
}

// Blended height of the face at a query point, in units of the radius.
float heightAt(CellCode code, CellHeader header, vec3 query) {
  uint detailCount = FRAME.detailCount;
  float sharpness = FRAME.detailSharpness;
  float weightSum = 0.0;
  float heightSum = 0.0;
  for (uint k = 0; k < detailCount; ++k) {
    DetailSite detail = loadDetailSite(code, header, detailCount, k);
    float weight = detailWeight(query, detail.place, sharpness);
    weightSum += weight;
    heightSum += weight * detail.height;
  }
  return heightSum / flooredWeightSum(weightSum);
}

// Cuts the interval by the displaced face.
void clipByFace(CellCode code, MetCell met, Frame frame, vec3 direction, inout float tNear, inout float tFar) {
  float facing = dot(frame.normal, direction);
  float height = 0.0;
  if (FRAME.hasHeights != 0) {
    float tQuery = placeOfHeight(met.centre, frame.normal, facing, tNear);
    CellHeader header = loadCellHeader(code, met.cell.x, met.cell.y);
    height = met.radius * heightAt(code, header, faceQueryAt(met, frame, direction, tQuery));
  }
  clipByFace(met.centre, frame.normal, facing, height, tNear, tFar);
}

// Display-coded colour at t, seen from the point that lies `behind` the ray's origin. shaded: how many detail sites
// took part.
vec3 colourAt(CellCode code, MetCell met, Frame frame, vec3 direction, float t, float behind, out uint shaded) {
  CellHeader header = loadCellHeader(code, met.cell.x, met.cell.y);
  uint detailCount = FRAME.detailCount;
  float sharpness = FRAME.detailSharpness;
  bool hasLobes = FRAME.lobeCount > 0;
  vec3 query = faceQueryAt(met, frame, direction, t);
  float weightSum = 0.0;
  for (uint k = 0; k < detailCount; ++k) {
    weightSum += detailWeight(query, loadDetailSite(code, header, detailCount, k).place, sharpness);
  }
  vec3 colour = vec3(0.0);
  float shownSum = 0.0;
  shaded = 0;
  for (uint k = 0; k < detailCount; ++k) {
    DetailSite detail = loadDetailSite(code, header, detailCount, k);
    float weight = detailWeight(query, detail.place, sharpness);
    if (!(weight > leastShownShare() * weightSum)) continue;
    vec3 toDetail = met.centre + behind * direction +
                  met.radius * (frame.tangent * detail.place.x + frame.bitangent * detail.place.y);
    vec3 seen = directionToDetail(toDetail, frame.normal);
    colour += weight * detailColour(code, header, detailCount, hasLobes, k, detail.base, seen);
    shownSum += weight;
    ++shaded;
  }
  return colour / flooredWeightSum(weightSum) * (shownSum > 0.0 ? weightSum / shownSum : 0.0);
}

#endif
