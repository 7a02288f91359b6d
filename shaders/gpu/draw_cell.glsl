// What rays do with a cell of the batch at hand of a tile's list: they composite what they gain in it.
#ifndef FROTH_GPU_DRAW_CELL_GLSL
#define FROTH_GPU_DRAW_CELL_GLSL
#include "gpu/tile_list.glsl"

// shadeHits in one piece: two rays per thread are 6 % slower through its two functions, single rays of a walk 6 %
// faster.
void shadeHitsAtOnce(Shading shading, uint visible, CellRecord cell, vec3 rays[kRays], Segment segments[kRays],
                     inout Radiance radiances[kRays]) {
  uint firstDetail = visible * detailCount;
  FaceView view = faceViewOf(cell, rays);
  clipByFace(shading, view, firstDetail, segments);
  bool isAny = false;
  vec3 queries[kRays];
  for (uint r = 0; r < kRays; ++r) {
    isAny = isAny || !isEmpty(segments[r]);
    queries[r] = queryAt(view, r, segments[r].tNear);
  }
  if (!isAny) return;
  vec3 colours[kRays];
  coloursAt(shading, firstDetail, queries, colours);
  compositeCell(shading, visible, cell, segments, colours, radiances);
}

void meetCell(Shading shading, uint index, vec3 rays[kRays], float ends[kRays], inout Radiance radiances[kRays]) {
  vec4 ball = balls[index];
  Segment segments[kRays];
  bool isAny = false;
  for (uint r = 0; r < kRays; ++r) {
    segments[r] = Segment(1.0, 0.0);
    if (isSaturated(shading, radiances[r])) continue;
    float tNear, tFar;
    if (!meetBall(ball, rays[r], tNear, tFar)) continue;
    countWork(kWorkBallHits, 1);
    if (isFull) tFar = min(tFar, ends[r]);
    segments[r] = Segment(tNear, tFar);
    isAny = true;
  }
  if (!isAny) return;
  if (clipByPlanes(shading, rows[index], rays, segments)) {
    shadeHitsAtOnce(shading, cells[index], shading.records.v[cells[index]], rays, segments, radiances);
  }
}

#endif
