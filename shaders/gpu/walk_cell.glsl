// What one ray meets in one cell (docs/FOAM.md "What one ray meets in one cell").
#ifndef FROTH_GPU_WALK_CELL_GLSL
#define FROTH_GPU_WALK_CELL_GLSL
#include "gpu/prepared_cells.glsl"
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
float heightAt(CellCode code, uvec2 cell, vec3 query) {
  CellHeader header = headerForHeights(code, cell);
  uint detailCount = FRAME.detailCount;
  float sharpness = FRAME.detailSharpness;
  float weightSum = 0.0;
  float heightSum = 0.0;
  for (uint k = 0; k < detailCount; ++k) {
    vec3 place = placeOfDetail(code, header, cell, k);
    float weight = detailWeight(query, place.xy, sharpness);
    weightSum += weight;
    heightSum += weight * place.z;
  }
  return heightSum / flooredWeightSum(weightSum);
}

// Cuts the interval by the displaced face.
void clipByFace(CellCode code, MetCell met, Frame frame, vec3 direction, inout float tNear, inout float tFar) {
  float facing = dot(frame.normal, direction);
  float height = 0.0;
  if (FRAME.hasHeights != 0) {
    float tQuery = placeOfHeight(met.centre, frame.normal, facing, tNear);
    height = met.radius * heightAt(code, met.cell, faceQueryAt(met, frame, direction, tQuery));
  }
  clipByFace(met.centre, frame.normal, facing, height, tNear, tFar);
}

// Display-coded colour at t, seen from the point that lies `behind` the ray's origin, or without lobes. shaded: how many
// detail sites took part.
vec3 colourAt(CellCode code, MetCell met, Frame frame, vec3 direction, float t, float behind, bool hasLobes,
              out uint shaded) {
  CellHeader header = headerForColours(code, met.cell);
  uint detailCount = FRAME.detailCount;
  float sharpness = FRAME.detailSharpness;
  vec3 query = faceQueryAt(met, frame, direction, t);
  float weightSum = 0.0;
  for (uint k = 0; k < detailCount; ++k) {
    weightSum += detailWeight(query, loadPlacedDetail(code, header, met.cell, k).place, sharpness);
  }
  vec3 colour = vec3(0.0);
  float shownSum = 0.0;
  shaded = 0;
  for (uint k = 0; k < detailCount; ++k) {
    DetailSite detail = loadPlacedDetail(code, header, met.cell, k);
    float weight = detailWeight(query, detail.place, sharpness);
    if (!(weight > leastShownShare() * weightSum)) continue;
    Lobes lobes = takeSeen(code, header, met.cell, k, hasLobes, detail);
    vec3 toDetail = met.centre + behind * direction +
                  met.radius * (frame.tangent * detail.place.x + frame.bitangent * detail.place.y);
    vec3 seen = directionToDetail(toDetail, frame.normal);
    colour += weight * seenColour(code, header, met.cell, lobes, detail.base, seen);
    shownSum += weight;
    ++shaded;
  }
  return colour / flooredWeightSum(weightSum) * (shownSum > 0.0 ? weightSum / shownSum : 0.0);
}

#endif
