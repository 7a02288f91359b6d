// What rays gather in one visible cell, once their intervals in the bounded cell are known (docs/FOAM.md "What one ray
// meets in one cell", steps 3 to 7). The same text for the raster and the walk.
//
// FROTH_RAYS rays of a thread meet a cell together: reading its detail sites costs more than working with them.
#ifndef FROTH_GPU_SHADE_HIT_GLSL
#define FROTH_GPU_SHADE_HIT_GLSL
#include "gpu/frame.glsl"
#include "gpu/view_rays.glsl"
#include "gpu/work.glsl"
#include "foam/appearance.h"
#include "foam/cell.h"
#include "foam/clip_face.h"
#include "foam/compositing.h"
#include "foam/quarters.h"

#if defined(FROTH_MERGED)
#define detailCount FRAME.detailCount
#define hasHeights (FRAME.hasHeights != 0)
#else
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;
layout(constant_id = kConstantHasHeights) const bool hasHeights = true;
#endif

const uint kRays = FROTH_RAYS;

struct Radiance {
  vec3 colour;  // display-coded, premultiplied
  float logTransmittance;
  vec3 normal;
  float distance;  // kInfinity until transmittance falls below the quantile
  uint cell;       // slot of the one in which that happened, until then of the last one that was met; kNoCell: none
  vec4 quarters;   // with keepsQuarters: foam/quarters.h; kInfinity: not reached
};

// What a ray asks of the frame over and over, to be held in registers.
struct Shading {
  RecordArray records;
  FloatQuadArray planes;
  DetailArray details;
  float detailSharpness, logCutoff, logQuantile;
};

Shading loadShading() {
  return Shading(FRAME.records, FRAME.planes, FRAME.details, FRAME.detailSharpness, FRAME.logCutoff, FRAME.logQuantile);
}

// A ray's interval in a cell; none: tFar <= tNear.
struct Segment {
  float tNear, tFar;
};

bool isEmpty(Segment segment) { return !(segment.tFar > segment.tNear); }

Radiance emptyRadiance() { return Radiance(vec3(0.0), 0.0, vec3(0.0), kInfinity, kNoCell, vec4(kInfinity)); }

bool isSaturated(Shading shading, Radiance radiance) { return radiance.logTransmittance < shading.logCutoff; }

// Rays and a cell's centre as seen from where they start, in the frame of the cell's face and in units of its radius.
struct FaceView {
  vec3 directions[kRays];
  vec3 centres[kRays];
};

vec3 inFaceOf(CellRecord cell, vec3 vector) {
  return inFaceFrame(vector, cell.tangent.xyz, cell.bitangent.xyz, cell.face.xyz, 1.0);
}

FaceView faceViewOf(CellRecord cell, vec3 rays[kRays]) {
  FaceView view;
  vec3 centre = vec3(cell.tangent.w, cell.bitangent.w, dot(cell.face.xyz, cell.ball.xyz));
  for (uint r = 0; r < kRays; ++r) {
    view.directions[r] = inFaceOf(cell, directionOfRay(rays[r]));
    view.centres[r] = isParallel ? centre - inFaceOf(cell, startOfRay(rays[r])) : centre;
  }
  return view;
}

vec3 queryAt(FaceView view, uint ray, float t) { return faceQuery(t * view.directions[ray] - view.centres[ray]); }

// Of the face in its own frame.
const vec3 kFaceNormal = vec3(0.0, 0.0, 1.0);

// Heights of the displaced face at query points, in units of the radius.
void heightsAt(Shading shading, uint firstDetail, vec3 queries[kRays], out float heights[kRays]) {
  float weightSums[kRays];
  for (uint r = 0; r < kRays; ++r) weightSums[r] = heights[r] = 0.0;
  for (uint k = 0; k < detailCount; ++k) {
    vec2 place = shading.details.v[firstDetail + k].place;
    float height = shading.details.v[firstDetail + k].height;
    for (uint r = 0; r < kRays; ++r) {
      float weight = detailWeight(queries[r], place, shading.detailSharpness);
      weightSums[r] += weight;
      heights[r] += weight * height;
    }
  }
  for (uint r = 0; r < kRays; ++r) heights[r] /= flooredWeightSum(weightSums[r]);
}

vec3 colourOfDetail(Shading shading, uint detail) {
  uvec2 words = shading.details.v[detail].colour;
  if (floatColours) return uintBitsToFloat(uvec3(words, shading.details.v[detail].blue));
  return vec3(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x);
}

void coloursAt(Shading shading, uint firstDetail, vec3 queries[kRays], out vec3 colours[kRays]) {
  float weightSums[kRays];
  for (uint r = 0; r < kRays; ++r) {
    weightSums[r] = 0.0;
    colours[r] = vec3(0.0);
  }
  for (uint k = 0; k < detailCount; ++k) {
    vec2 place = shading.details.v[firstDetail + k].place;
    vec3 colour = colourOfDetail(shading, firstDetail + k);
    for (uint r = 0; r < kRays; ++r) {
      float weight = detailWeight(queries[r], place, shading.detailSharpness);
      weightSums[r] += weight;
      colours[r] += weight * colour;
    }
  }
  for (uint r = 0; r < kRays; ++r) colours[r] /= flooredWeightSum(weightSums[r]);
}

// Cuts the intervals by the displaced face.
void clipByFace(Shading shading, FaceView view, uint firstDetail, inout Segment segments[kRays]) {
  float heights[kRays];
  for (uint r = 0; r < kRays; ++r) heights[r] = 0.0;
  if (hasHeights) {
    vec3 queries[kRays];
    for (uint r = 0; r < kRays; ++r) {
      float t = placeOfHeight(view.centres[r], kFaceNormal, view.directions[r].z, segments[r].tNear);
      queries[r] = queryAt(view, r, t);
      countWork(kWorkHeights, isEmpty(segments[r]) ? 0 : 1);
    }
    heightsAt(shading, firstDetail, queries, heights);
  }
  for (uint r = 0; r < kRays; ++r) {
    clipByFace(view.centres[r], kFaceNormal, view.directions[r].z, heights[r], segments[r].tNear, segments[r].tFar);
  }
}

// Those below whose middle transmittance falls in an interval from tNear on; before, after: logarithms of it.
void placeQuarters(float tNear, float density, float before, float after, inout vec4 quarters) {
  for (int i = 0; i < 4; ++i) {
    float middle = log(middleOfQuarter(i));
    if (before >= middle && after < middle) quarters[i] = quantileDistance(tNear, before, middle, density);
  }
}

// Adds an interval of constant density and colour. `normal`: unit.
void composite(Shading shading, Segment segment, float density, vec3 colour, vec3 normal, inout Radiance radiance) {
  float opticalDepth = density * (segment.tFar - segment.tNear);
  float weight = exp(radiance.logTransmittance) * opacity(opticalDepth);
  radiance.colour += weight * colour;
  if (isFull) radiance.normal += weight * normal;
  float after = radiance.logTransmittance - opticalDepth;
  if (radiance.logTransmittance >= shading.logQuantile && after < shading.logQuantile) {
    radiance.distance = quantileDistance(segment.tNear, radiance.logTransmittance, shading.logQuantile, density);
  }
  if (keepsQuarters) placeQuarters(segment.tNear, density, radiance.logTransmittance, after, radiance.quarters);
  radiance.logTransmittance = after;
}

// Cuts the intervals down to what shows, and finds its colours; false: nothing does.
bool shadeSegments(Shading shading, uint visible, CellRecord cell, vec3 rays[kRays], inout Segment segments[kRays],
                   out vec3 colours[kRays]) {
  uint firstDetail = visible * detailCount;
  FaceView view = faceViewOf(cell, rays);
  clipByFace(shading, view, firstDetail, segments);
  bool isAny = false;
  vec3 queries[kRays];
  for (uint r = 0; r < kRays; ++r) {
    isAny = isAny || !isEmpty(segments[r]);
    queries[r] = queryAt(view, r, segments[r].tNear);
  }
  if (isAny) coloursAt(shading, firstDetail, queries, colours);
  return isAny;
}

void compositeCell(Shading shading, uint visible, CellRecord cell, Segment segments[kRays], vec3 colours[kRays],
                   inout Radiance radiances[kRays]) {
  for (uint r = 0; r < kRays; ++r) {
    if (isEmpty(segments[r])) continue;
    countWork(kWorkColours, 1);
    if (isFull && radiances[r].distance == kInfinity) radiances[r].cell = visible;
    composite(shading, segments[r], cell.face.w, colours[r], cell.ball.w * cell.face.xyz, radiances[r]);
  }
}

void shadeHits(Shading shading, uint visible, CellRecord cell, vec3 rays[kRays], Segment segments[kRays],
               inout Radiance radiances[kRays]) {
  vec3 colours[kRays];
  if (!shadeSegments(shading, visible, cell, rays, segments, colours)) return;
  compositeCell(shading, visible, cell, segments, colours, radiances);
}

#endif
