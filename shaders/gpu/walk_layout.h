// What crosses the border between the recording code and rays in an engine's shaders: one text for C++ and GLSL, by the
// rules of gpu/layout.h. Changing it means another FROTH_WALK_ABI (runtime/include/froth/froth_walk.h and
// froth_walk.glsl).
#ifndef FROTH_GPU_WALK_LAYOUT_H
#define FROTH_GPU_WALK_LAYOUT_H
#include "layout.h"

#if defined(__cplusplus)
namespace froth::gpu {
#define FROTH_ADDRESS(type) uint64_t
#define FROTH_CONST constexpr uint
#else
#define FROTH_ADDRESS(type) type
#define FROTH_CONST const uint
#endif

FROTH_CONST kBindingWalk = 0;
FROTH_CONST kBindingWalkCounters = 1;
FROTH_CONST kWalkBindingCount = 2;

FROTH_CONST kRayGroupSize = 64;

// WalkBlock::flags
FROTH_CONST kWalkCountsWork = 1;

// WalkCounters::work: low, high word by kind.
FROTH_CONST kRayWorkRays = 0;
FROTH_CONST kRayWorkDescents = 1;    // cells on the way to where walks begin
FROTH_CONST kRayWorkCells = 2;       // cells walked through
FROTH_CONST kRayWorkNeighbours = 3;  // their neighbours
FROTH_CONST kRayWorkMet = 4;         // cells in which a ray meets the ball
FROTH_CONST kRayWorkShaded = 5;      // detail sites whose colour was found
FROTH_CONST kRayWorkKinds = 6;

struct WalkCounters {
  uint stepLimit;   // rays ended by WalkInstance::maxSteps or maxNeighbours
  uint version;     // rays of shaders that were compiled with another FROTH_WALK_ABI
  uint violations;  // indices out of range
  uint padding;
  uint work[2 * kRayWorkKinds];  // with kWalkCountsWork
};

// An instance as rays meet it. Directions and lengths are in the asset's axes and units, places relative to
// FrothWalkInfo::eye.
struct WalkInstance {
  vec4 worldX;  // rows of the rotation world-from-asset
  vec4 worldY;
  vec4 worldZ;
  vec4 boxLow;   // of the balls of live cells; w: more than rounding cuts off the box, so far from the eye
  vec4 boxSize;  // has the same bits wherever the eye is, and so have the parts of the grid of entries
  float scale, detailSharpness;
  uint mask, userId;
  uint chunkCount, localBits, maxSteps, detailCount;
  uint lobeCount, hasHeights;
  uint entriesAlong;  // edge of the grid of entries
  uint maxNeighbours;
  float exposure;
  uint borderCount, fileChunkCount, firstSlot;  // as in FrameBlock
  FROTH_ADDRESS(ChunkArray) chunks;             // [chunkCount]
  // [entriesAlong^3] over the box, x first: slot, local index of the cell at its middle, 64 bits of parts
  // (gpu/walk_entries.glsl)
  FROTH_ADDRESS(UintQuadArray) entries;
  FROTH_ADDRESS(UintArray) borders;
  uint prepared, padding;  // kPreparedNothing...: of this one
};

#if !defined(__cplusplus)
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer WalkInstanceArray { WalkInstance v[]; };
#endif

struct WalkBlock {
  uint abi;  // FROTH_WALK_ABI
  uint instanceCount;
  float logCutoff, logQuantile;
  uint flags;
  uint prepared;                               // kPreparedNothing...: of all instances
  FROTH_ADDRESS(WalkInstanceArray) instances;  // [instanceCount]
};

#if defined(__cplusplus)
static_assert(sizeof(WalkCounters) == 64 && offsetof(WalkCounters, work) == 16);
static_assert(sizeof(WalkInstance) == 176 && offsetof(WalkInstance, scale) == 80 &&
              offsetof(WalkInstance, chunks) == 144);
static_assert(sizeof(WalkBlock) == 32 && offsetof(WalkBlock, instances) == 24);
}  // namespace froth::gpu
#endif

#undef FROTH_ADDRESS
#undef FROTH_CONST
#endif
