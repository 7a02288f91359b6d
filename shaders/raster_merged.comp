// Draws the tiles that several instances share whose boxes meet. 8 x 8 pixels go through the list of one instance after
// the other, as where an instance is alone, but keep what they find, to be merged by distance.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_RAYS 1
#define FROTH_MERGED
#include "gpu/hit_records.glsl"
#include "gpu/shared_tiles.glsl"
#include "gpu/tile_list.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

shared uint resumes[kMostInstances];  // entries of the lists at which a round begins
shared float begins[kMostInstances];
shared uint isGoingOn;

// Of each list: the first entry of the batch in which the ray of this thread was cut, or the list's end if it was not.
uint cutBatches[kMostInstances];

float beginOf(uint part) { return begins[part]; }

void meetCell(Shading shading, uint index, vec3 rays[kRays], float ends[kRays], inout Radiance radiances[kRays]) {
  Segment segments[kRays];
  if (!meetBall(balls[index], rays[0], segments[0].tNear, segments[0].tFar)) return;
  countWork(kWorkBallHits, 1);
  if (!clipByPlanes(shading, rows[index], rays, segments)) return;
  if (!isBehindKnown(segments[0].tNear)) {  // then so are all cells that come after it
    segments[0].tFar = min(segments[0].tFar, ends[0]);
    CellRecord cell = shading.records.v[cells[index]];
    vec3 colours[kRays];
    if (isEmpty(segments[0]) || !shadeSegments(shading, cells[index], cell, rays, segments, colours)) return;
    countWork(kWorkColours, 1);
    recordHit(shading, segments[0], cell.face.w, colours[0], cells[index], radiances[0].logTransmittance);
  }
  if (!isCut) return;
  cutBatches[partAtHand] = batchBegin;
  radiances[0].logTransmittance = -kInfinity;
}

// The first round begins at the first entry of each list. Every thread calls it, at the same place.
void startLists(uint tile, uint parts) {
  uint part = gl_LocalInvocationIndex;
  if (part < kMostInstances && (parts >> part & 1) != 0) {
    selectPart(part);
    resumes[part] = tileRange(push.parts[part], tile).x;
    vec4 ball = FRAME.records.v[checked(FRAME.tileCells.v[resumes[part]], FRAME.visibleCapacity)].ball;
    begins[part] = distanceToBall(ball.xyz, ball.w) * FRAME.scale;
  }
  barrier();
}

// What the rays gain from one list. Every thread calls it, at the same place.
void readList(uint part, uint tile, uvec2 corner, bool goesOn, float logTransmittance) {
  startPart(part);
  uvec2 range = uvec2(resumes[part], tileRange(push.parts[part], tile).y);
  vec3 ray = rayOf(pixelOfThread(corner, 0));
  float end = goesOn && !isCut ? endInPart(ray) : 0.0;
  if (goesOn && !isCut) cutBatches[part] = range.y;
  Radiance radiances[kRays] = Radiance[](emptyRadiance());
  radiances[0].logTransmittance = end > 0.0 ? logTransmittance : -kInfinity;
  drawList(loadShading(), range, corner, vec3[](ray), float[](end), radiances);
  barrier();  // the next list may overwrite what its last batch was asked for
}

// The next round begins, in each list, where the first ray that goes on was cut. False: none goes on. Every thread calls
// it, at the same place.
bool startNextRound(uint parts, bool goesOn) {
  uint lane = gl_LocalInvocationIndex;
  barrier();
  if (lane < kMostInstances) resumes[lane] = 0xffffffffu;
  if (lane == 0) isGoingOn = 0;
  barrier();
  if (goesOn) {
    atomicOr(isGoingOn, 1u);
    for (uint left = parts; left != 0; left &= left - 1) atomicMin(resumes[findLSB(left)], cutBatches[findLSB(left)]);
  }
  barrier();
  return isGoingOn != 0;
}

void main() {
  selectPart(0);
  uvec2 corner = gl_WorkGroupID.xy * kSubTileSize;
  uint tile = corner.y / kTileSize * FRAME.tilesX + corner.x / kTileSize;
  uint parts = partsIn(tile);
  if (!isInRegion(corner) || isAlone(parts) || isInOrder(parts)) return;
  uvec2 pixel = pixelOfThread(corner, 0);
  bool goesOn = isInRegion(pixel) && !seesNothing(rayOf(pixel));
  startRay(parts, goesOn ? findRayEnd(pixel) : 0.0);
  startLists(tile, parts);
  Merged merged = emptyMerged();
  do {
    known = rayEnd;
    for (uint left = parts; left != 0;) {
      readList(takeNearest(left), tile, corner, goesOn, merged.radiance.logTransmittance);
    }
    goesOn = goesOn && mergeRecords(merged);
  } while (startNextRound(parts, goesOn));
  if (isInRegion(pixel)) writeMerged(pixel, merged);
}
