// What crosses the border between the recording code and the render passes: one text for C++ and GLSL.
//
// Large arrays are reached by address. Structs hold only 4-byte scalars, 16-byte vectors and 8-byte addresses, each at
// a multiple of its size, so that C++ and std430 agree without padding rules; the static_asserts below hold them to it.
#ifndef FROTH_GPU_LAYOUT_H
#define FROTH_GPU_LAYOUT_H

#if defined(__cplusplus)

#include <array>
#include <cstddef>
#include <cstdint>

namespace froth::gpu {
using uint = uint32_t;
using uvec4 = std::array<uint32_t, 4>;
using vec4 = std::array<float, 4>;
using uvec2 = std::array<uint32_t, 2>;
using vec2 = std::array<float, 2>;
#define FROTH_ADDRESS(type) uint64_t
#define FROTH_CONST constexpr uint

#else

layout(buffer_reference, std430, buffer_reference_align = 4) buffer UintArray { uint v[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer UintPairArray { uvec2 v[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer UintQuadArray { uvec4 v[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer FloatQuadArray { vec4 v[]; };
#define FROTH_ADDRESS(type) type
#define FROTH_CONST const uint

#endif

FROTH_CONST kGroupSize = 256;          // threads of a workgroup in all passes over lists
FROTH_CONST kMostGroupsAlong = 65535;  // workgroups of a dispatch along one dimension that every device takes
FROTH_CONST kSortDigits = 256;         // values of a digit, as many as a workgroup has threads
FROTH_CONST kManyKeysRounds = 4;       // FrameBlock::sortRounds of long lists; 1 of others
FROTH_CONST kSortGroupsPerSum = 32;    // rows of a histogram that have a row of sums before them
FROTH_CONST kTileCellsPerGroup = 64;   // visible cells whose tiles one workgroup tests
FROTH_CONST kCellsPerTileSum = 1024;   // visible cells whose tiles are summed for the prefixes of pairs
FROTH_CONST kTileSize = 32;            // [pixels] edge of the tiles that own lists
FROTH_CONST kSubTileSize = 8;          // [pixels] edge of what one workgroup of the raster draws
FROTH_CONST kBlockTiles = 8;           // [tiles] edge of the blocks of tiles that have a cone
FROTH_CONST kSubTilesPerTile = 16;
// a list longer than this part of all pairs is a long one: drawn by more threads, and first
FROTH_CONST kTilesAtOnce = 512;
FROTH_CONST kMaskWords = 8;       // words of a bit per thread of a workgroup
FROTH_CONST kMostInstances = 14;  // that one recording draws: what push constants hold
FROTH_CONST kNoCell = 0xffffffffu;
// in a walk's link: the other bits are a site of the chunk, whose cell has no record
FROTH_CONST kUnlisted = 0x80000000u;
FROTH_CONST kRasterLanes = 8;          // threads that expand one visible cell: its alpha-complex neighbours,
FROTH_CONST kWalkLanes = 32;           // or all of them, hundreds where a cell fills a room
FROTH_CONST kWholeBall = 0x40202020u;  // ChunkContents::solidBalls: the cell's own ball

// What rays from anywhere find prepared of an asset's cells (gpu/prepared_cells.glsl); each holds those before it.
FROTH_CONST kPreparedNothing = 0;
FROTH_CONST kPreparedVisibility = 1;  // planes and faces, and the places of details where they have heights
FROTH_CONST kPreparedRadiance = 2;    // the places of details and what their colours begin with
FROTH_CONST kFaceQuads = 2;           // of a live cell

// FrameBlock::sizeCounts: keys of cells in view (gpu/cell_sizes.glsl). Four classes of sizes an octave; cells of one
// class are told apart by what neighbours do not share.
FROTH_CONST kSizeClasses = 64;
FROTH_CONST kKeysPerSize = 32;
FROTH_CONST kSizeKeys = 2048;

// SortConstants::step: what a pass of the radix sort does with a key besides moving it.
FROTH_CONST kSortCountNextDigit = 0;
FROTH_CONST kSortTakeTileCounts = 1;  // last digit of cells
FROTH_CONST kSortOnlyMove = 2;        // last digit of pairs

// Specialization constants of all shaders.
FROTH_CONST kConstantCheckIndices = 0;
FROTH_CONST kConstantDetailCount = 1;
FROTH_CONST kConstantLobeCount = 2;
FROTH_CONST kConstantHasHeights = 3;
FROTH_CONST kConstantCountWork = 4;
FROTH_CONST kConstantIsFull = 5;  // the frame wants more than colour and distance, or has a scene's depth
FROTH_CONST kConstantLensClass = 6;
FROTH_CONST kConstantFloatColours = 7;   // DetailRecord::colour
FROTH_CONST kConstantKeepsQuarters = 8;  // full frames can have FrameBlock::quarters

// How the passes of a pipeline see: kConstantLensClass.
FROTH_CONST kLensClassPinhole = 0;
FROTH_CONST kLensClassMapped = 1;  // any rays through one eye: FrameBlock::rays
FROTH_CONST kLensClassOrthographic = 2;
FROTH_CONST kLensClassCount = 3;

// The caller's images in the descriptor set: those that are written, then those that are read.
FROTH_CONST kBindingColour = 0;
FROTH_CONST kBindingDistance = 1;
FROTH_CONST kBindingNormal = 2;
FROTH_CONST kBindingDepth = 3;
FROTH_CONST kBindingRayMap = 4;
FROTH_CONST kBindingSceneDepth = 5;
FROTH_CONST kBindingCount = 6;

// FrameBlock::flags
FROTH_CONST kFlagColour = 1;
FROTH_CONST kFlagDistance = 2;
FROTH_CONST kFlagNormal = 4;
FROTH_CONST kFlagDisplayCoded = 8;
FROTH_CONST kFlagDepth = 32;
FROTH_CONST kFlagSceneDepth = 64;
FROTH_CONST kFlagHits = 128;
FROTH_CONST kFlagQuarters = 2048;
FROTH_CONST kFlagShortTiles = 256;   // all tiles are drawn as short ones,
FROTH_CONST kFlagLongTiles = 512;    // or as long ones (FrothRenderInfo::tileForm)
FROTH_CONST kFlagCountSizes = 1024;  // there may be no room for all cells in view: the largest stay
FROTH_CONST kToneCurveShift = 16;    // above it: foam/tone.h
// list cells that guide walks too, and the planes of all neighbours; else a raster: sort the cells, shade only those
// that own a (tile, cell) pair
FROTH_CONST kFlagWalk = 16;

// How the bits of a chunk's live cells are to be read (runtime/asset/cell_packer.h).
struct CellCode {
  // what a code is multiplied with; 0: it is a float's bits
  float placeStep, heightStep, baseStep, axisStep, colourStep;
  uint densityShift, densityLowest, densityBits;  // a density is the float of bits (lowest + code) << shift
  uint normalBits;            // per axis of an octahedral normal; 0: the orientation is a quaternion of floats
  uint scaleBits;             // a cell's colours are in steps of step * 2^scale
  uint widthBits;             // of the widths in a cell's header
  uint heightBits, baseBits;  // of a cell's lowest height and base colour
  uint axisBits, axisCount;   // a written-out axis' component; axes in the table
  uint ownAxisBits;           // of the number of axes that a cell writes out beside the table
};

// One chunk of the asset, seen from this frame's eye. The arrays: GpuChunk (runtime/asset/gpu_asset.h). With levels, a
// slot: that of a chunk which is not drawn is all zero.
struct ChunkEntry {
  vec4 offsetHigh;  // xyz: chunk origin minus eye in the asset's axes; the high and
  vec4 offsetLow;   //      the low part of a double [scene units of the asset]
  FROTH_ADDRESS(FloatQuadArray) siteRadius;
  FROTH_ADDRESS(UintArray) neighbourOffsets;
  FROTH_ADDRESS(UintArray) neighbours;
  FROTH_ADDRESS(UintArray) ghostRefs;
  FROTH_ADDRESS(UintArray) alphaCounts;
  FROTH_ADDRESS(UintArray) cellStarts;
  FROTH_ADDRESS(UintArray) cellWords;
  FROTH_ADDRESS(UintArray) solidBalls;
  uint cellCount, liveCount;
  uint siteCount;  // cells and ghosts
  uint neighbourCount;
  uint neighbourShift, alphaShift;  // elements of 32 >> shift bits
  uint cellWordCount;
  uint hasSolidBalls;
  uint firstGroup;  // of the workgroups over its cells, in a grid of kGroupSize cells each over those of all chunks
  uint number;      // of the chunk in the file: what its cells are called outside (namedCell() of gpu/asset.glsl)
  FROTH_ADDRESS(UintQuadArray) prepared;  // gpu/prepared_cells.glsl; absent: kPreparedNothing
  CellCode code;
  uint lobeTotal, lobeQuads, lobesPlaced, padding;  // of `prepared`: quads of a lobe; lobes with a place so far
};

// A visible cell as the rays meet it; for a walk also a cell that only guides it. Positions are relative to the eye.
struct CellRecord {
  vec4 ball;       // centre, radius; radius 0: nothing to be seen
  vec4 face;       // n / radius, density; the frame's vectors are scaled so that a face is seen in units of the radius
  vec4 tangent;    // t / radius, its dot product with the centre
  vec4 bitangent;  // b / radius, its dot product with the centre
  uint planeBegin, planeSplit, planeEnd;  // eye planes: [begin, split) only lower tFar, [split, end) only raise tNear
  uint solidBall;                         // bytes of GpuChunk::solidBalls
};

// A detail site of a visible cell, seen from the eye. What a ray reads most, so it is small: colours are halves, off by
// at most 2^-12 below 1, a sixteenth of an 8-bit step.
struct DetailRecord {
  vec2 place;  // (u, v)
  float height;
  uint blue;     // float, with kConstantFloatColours
  uvec2 colour;  // halves r, g; b, 0. With kConstantFloatColours floats r; g
};

// Counters::work: what rays cost. Rays count by themselves, entries by workgroup of kSubTileSize x kSubTileSize pixels.
FROTH_CONST kWorkEntries = 0;      // entries of their tiles' lists that workgroups read
FROTH_CONST kWorkEntriesKept = 1;  // of these, those that a ray of the workgroup can meet
FROTH_CONST kWorkBallHits = 2;     // balls met by rays
FROTH_CONST kWorkPlanes = 3;       // radical planes that clipped a ray's interval in a ball
FROTH_CONST kWorkHeights = 4;      // sums over detail sites for a height
FROTH_CONST kWorkColours = 5;      // sums over detail sites for a colour: contributions to a ray
FROTH_CONST kWorkSteps = 6;        // of walks from cell to cell
FROTH_CONST kWorkNeighbours = 7;   // neighbours tested in these steps
FROTH_CONST kWorkKinds = 8;

// Written by the passes, cleared per frame, copied to the host. Each dispatch is a VkDispatchIndirectCommand.
struct Counters {
  uint cellsWanted;   // visible cells
  uint planesWanted;  // of the visible cells; saturates
  uint visibleCells;  // of the wanted ones the largest, as far as there was space for them and their planes
  uint pairs;         // (tile, cell) pairs of those; saturates
  uint pairsKept;     // of these, those that had space
  uint stepLimit;     // walks that maxSteps or maxNeighbours ended
  uint violations;    // indices out of range (checkIndices)
  uint longTiles;     // the first ones of FrameBlock::tileLists
  uint longestList;   // entries of a tile, those beyond maxEntries included
  uint isCut;         // 1: it is longer than maxEntries
  // choose_cells.comp: the least size key of cells that stay; 0: all stay
  uint leastKey;
  uint droppedCells, droppedPlanes, droppedPairs;  // of cells below it; pairs by a guess
  uint padding[2];
  uvec4 dropDispatch;         // of cull_cells.comp, once more; none if all stay
  uvec4 expandDispatch;       // kRasterLanes or kWalkLanes threads per visible cell
  uvec4 detailDispatch;       // a thread per detail site of a visible cell
  uvec4 cellSortDispatch;     // a workgroup per sortRounds * kGroupSize visible cells
  uvec4 tileDispatch;         // a workgroup per kTileCellsPerGroup visible cells
  uvec4 pairSortDispatch;     // a workgroup per sortRounds * kGroupSize kept pairs
  uvec4 longTileDispatch;     // a workgroup per sub-tile of the long tiles,
  uvec4 tileDrawDispatch;     // of all others
  uint work[2 * kWorkKinds];  // low, high word by kind; stay zero without kConstantCountWork
};

#if !defined(__cplusplus)
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer ChunkArray { ChunkEntry v[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer RecordArray { CellRecord v[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer DetailArray { DetailRecord v[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer CountersRef { Counters v; };
#endif

// One recording of one view. Directions and lengths are in the asset's axes and units.
struct FrameBlock {
  vec4 rayOrigin;  // Pinhole: direction of pixel (column, row) of the region, not normalized:
  vec4 rayX;       // rayOrigin + (column - rayX.w) rayX.xyz + (row - rayY.w) rayY.xyz. Mapped: the view's axes z, x, y.
  // Orthographic: (u, v) of a pixel, by the same sum from 0. The lens' middle is at (rayX.w, rayY.w): there a sum from
  // another pixel on loses what a wide lens' steps are longer by than its middle ray.
  vec4 rayY;
  vec4 forward;   // unit view axis, nearDepth
  vec4 depthRow;  // device depth of a point relative to the eye: (depthRow . p) / (depthScale . p), homogeneous
  vec4 depthScale;
  vec4 depthRange;  // least and most of the viewport, the end (0, 1) that is far, its depth
  vec4 worldX;      // rows of the rotation world-from-asset
  vec4 worldY;
  vec4 worldZ;
  // Mapped: pixel (column, row) of the region sees lensPoint.xy + (column, row) lensPoint.zw, as foam/lens.h
  vec4 lensPoint;
  vec4 lensFirst, lensSecond;  // takes it. Orthographic: unit vectors along u and v, on the plane through the eye
  float nearRatio, scale, logCutoff, logQuantile;
  float detailSharpness;
  uint flags, maxEntries, maxSteps, maxNeighbours;  // of the drawn part of a tile's list; of a walk
  uint localBits;
  uint regionX, regionY, regionWidth, regionHeight;  // [pixels] what is drawn
  uint tilesX, tilesY, chunkCount, groupCount;       // groups: ChunkEntry::firstGroup
  uint visibleCapacity, planeCapacity, pairCapacity;
  uint sortRounds;  // keys that a thread ranks in a pass of a radix sort
  float lensRange;
  uint lensKind, blocksX, blocksY;  // blocks of kBlockTiles x kBlockTiles tiles
  // of the asset; passes that are specialized on its shape do not read them
  uint detailCount, lobeCount, hasHeights;
  float exposure;
  FROTH_ADDRESS(CountersRef) counters;
  FROTH_ADDRESS(ChunkArray) chunks;           // [chunkCount]
  FROTH_ADDRESS(UintPairArray) groupSums;     // [groupCount] visible cells, their planes
  FROTH_ADDRESS(UintPairArray) superSums;     // [a kGroupSize-th of that] sums of kGroupSize groupSums
  FROTH_ADDRESS(UintPairArray) sizeCounts;    // [kSizeKeys] with kFlagCountSizes: cells in view, their planes
  FROTH_ADDRESS(UintPairArray) visibility;    // [groupCount * kMaskWords] 32 bits, slot of the first bit
  FROTH_ADDRESS(UintQuadArray) visibleCells;  // [slot] chunk, local index, first plane, planes
  // [slot] order-preserving bits of the power of the eye, or along parallel rays
  FROTH_ADDRESS(UintArray) cellKeys;
  FROTH_ADDRESS(UintArray) order;        // [visible cell] slot
  FROTH_ADDRESS(RecordArray) records;    // [slot]
  FROTH_ADDRESS(FloatQuadArray) planes;  // [planeCapacity] xyz: gpu/view_rays.glsl; w for a walk: link
  FROTH_ADDRESS(DetailArray) details;    // [slot * K]
  FROTH_ADDRESS(UintArray) slotTiles;    // [slot] tiles its solid ball meets
  FROTH_ADDRESS(UintArray) tileCounts;   // [visible cell] the same
  FROTH_ADDRESS(UintArray) tileSums;     // [visible cell / kCellsPerTileSum] their sums
  FROTH_ADDRESS(UintArray) pairTiles;    // [pair] as emitted
  FROTH_ADDRESS(UintArray) pairCells;    // slots
  FROTH_ADDRESS(UintArray) tileCells;    // [pair] slots in the order of tiles
  // [tile] pairs; order_tiles.comp makes that the place in tileLists; one more (emit_pairs.comp). Of a walk: what
  // nearest_balls.comp says
  FROTH_ADDRESS(UintArray) tileLengths;
  FROTH_ADDRESS(UintQuadArray) tileLists;  // [tiles, longest lists first] tile, begin and end in tileCells
  FROTH_ADDRESS(UintArray) cellHistogram;  // of the lowest digit of cellKeys (histogram.glsl)
  FROTH_ADDRESS(UintArray) pairHistogram;  // of the lowest digit of pairTiles
  // [tile] chunk, local index of the cell in which a walk along its middle ray begins; kept over frames
  FROTH_ADDRESS(UintPairArray) walkStart;
  FROTH_ADDRESS(FloatQuadArray) rays;     // [row of the region, column] xyz: unit direction; 0: none
  FROTH_ADDRESS(FloatQuadArray) cones;    // (foam/cones.h) [tile * kSubTilesPerTile + sub-tile], [tile], [block]
  FROTH_ADDRESS(UintArray) hits;          // [row of the region, column] kHitWords each, with kFlagHits
  uint part;                              // which instance of the recording it is
  uint zero;                              // 0, which compilers do not know
  FROTH_ADDRESS(UintQuadArray) quarters;  // [row of the region, column] with kFlagQuarters
  // With levels, and only for walks: where the cells of borders and the chunks of the file are now
  // (publish_borders.comp)
  FROTH_ADDRESS(UintArray) borders;  // [borderCount] slot << localBits | local index; [fileChunkCount] slot
  uint borderCount, fileChunkCount;  // 0: no levels
  uint firstSlot;                    // that is drawn
  uint overlaps;                     // bits: parts of the recording whose boxes meet that of this one (part_order.h)
  vec4 boxLow, boxHigh;  // around the balls of live cells, relative to the eye, with what rounding takes from rays
};

// A hit: where a pixel's ray was stopped, by bits of a float [world units] (+inf: nowhere), the instance (an index of
// HitBlock::instances), and the code of the cell there, or of the last one that the ray met: chunk << localBits | cell,
// or kNoCell.
FROTH_CONST kHitWords = 3;

// The quarters of a pixel (foam/quarters.h), a word each: bits of the distance as in a hit, of which the lowest are the
// instance.
FROTH_CONST kQuarterPartMask = 15;

// Lies at this offset in the space of a FrameBlock.
FROTH_CONST kHitBlockOffset = 640;

struct HitInstance {
  vec4 rows[3];  // as HitBlock::backgroundRows
  uint userId;
  uint padding[3];
};

#if !defined(__cplusplus)
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer HitInstanceArray { HitInstance v[]; };
#endif

// What the passes over hits know. All vectors are in world axes and units, relative to the eye.
struct HitBlock {
  vec4 rayOrigin, rayX, rayY, forward;  // as in FrameBlock
  vec4 lensPoint, lensFirst, lensSecond;
  vec4 previousFirst, previousSecond;  // the same of the frame before
  vec4 previousPixels;                 // its lens' focal lengths and centre [pixels]
  // (point, 1) or (direction, 0) -> by a projection of the frame before: x w, y w, w with x, y in pixels; by another
  // lens: the point in that view's axes
  vec4 backgroundRows[3];
  vec4 pixels;                  // unjittered place of the region's first pixel, motionScale
  uint lensKind, previousKind;  // foam/lens.h
  float lensRange, previousRange;
  uint regionX, regionY, regionWidth, regionHeight;
  uint hasPrevious;
  uint padding;
  FROTH_ADDRESS(UintArray) hits;
  FROTH_ADDRESS(HitInstanceArray) instances;
  FROTH_ADDRESS(UintQuadArray) quarters;
};

// Push constants of composite.comp. [pixels]
struct CompositeConstants {
  uint x, y, width, height;
  uint hasShadow;
};

#if defined(__cplusplus)

// Push constants of the radix sort.
struct SortConstants {
  uint64_t frame, keysIn, valuesIn, keysOut, valuesOut, count, histogram, nextHistogram;
  uint shift, capacity, step, padding;
};

// Push constants of publish_borders.comp.
struct BorderConstants {
  uint64_t borders;                     // FrameBlock::borders
  uint64_t borderCells, borderNumbers;  // of the chunk (runtime/asset/gpu_asset.h)
  uint count, firstCode;                // its borders; slot << localBits
  uint slot, slotPlace;                 // which is written to borders[slotPlace]
};

// Push constants of fade.comp.
struct FadeConstants {
  uint64_t frame;
  uint64_t kept;  // [row of the region, column] four halves
  float weight;   // of the colours in the image [0..1); 0: they are kept
  uint padding;
};

// Push constants of all other passes.
struct PassConstants {
  uint64_t frame;
};

// Push constants of the passes that write the caller's images, behind PassConstants: all instances of the recording.
struct PartConstants {
  uint partCount, padding;
  std::array<uint64_t, kMostInstances> parts;  // FrameBlock
};

static_assert(sizeof(ChunkEntry) == 224 && offsetof(ChunkEntry, siteRadius) == 32);
static_assert(offsetof(ChunkEntry, cellCount) == 96 && offsetof(ChunkEntry, prepared) == 136 &&
              offsetof(ChunkEntry, code) == 144 && sizeof(CellCode) == 64);
static_assert(sizeof(DetailRecord) == 24 && offsetof(DetailRecord, colour) == 16);
static_assert(sizeof(CellRecord) == 80 && offsetof(CellRecord, planeBegin) == 64);
static_assert(kSizeClasses * kKeysPerSize == kSizeKeys && kSizeKeys % kGroupSize == 0);
static_assert(offsetof(Counters, dropDispatch) == 64 && offsetof(Counters, work) == 192 && sizeof(Counters) == 256);
static_assert(offsetof(FrameBlock, nearRatio) == 208 && offsetof(FrameBlock, regionX) == 248);
static_assert(offsetof(FrameBlock, counters) == 328 && sizeof(FrameBlock) == 608);
static_assert(sizeof(FrameBlock) <= kHitBlockOffset && sizeof(HitInstance) == 64);
static_assert(offsetof(HitBlock, pixels) == 208 && offsetof(HitBlock, hasPrevious) == 256 && sizeof(HitBlock) == 288);
static_assert(kMostInstances <= kQuarterPartMask + 1);
static_assert(sizeof(SortConstants) == 80 && sizeof(PassConstants) == 8 && sizeof(BorderConstants) == 40 &&
              sizeof(FadeConstants) == 24);
static_assert(sizeof(PassConstants) + sizeof(PartConstants) <= 128, "what every device has");

}  // namespace froth::gpu

#else
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer FrameRef { FrameBlock v; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer HitRef { HitBlock v; };

#endif

#undef FROTH_ADDRESS
#undef FROTH_CONST
#endif
