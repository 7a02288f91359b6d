#include "runtime/render/frame_block.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "format/to_vector.h"
#include "runtime/render/device_depth.h"
#include "runtime/render/frame_images.h"
#include "shaders/foam/tone.h"

namespace froth {
namespace {

static_assert(int{FROTH_TONE_REINHARD} == foam::kToneReinhard &&
              int{FROTH_TONE_ACES_NARKOWICZ} == foam::kToneAcesNarkowicz &&
              int{FROTH_TONE_KHRONOS_NEUTRAL} == foam::kToneKhronosNeutral);

void fillCamera(const FrothRenderInfo& info, const CameraRays& rays, const RenderInstance& instance,
                gpu::FrameBlock& block) {
  fillRays(info.camera, rays, block);
  fillDepthRows(info.camera, rays, instance.scale, block);
  block.forward[3] = static_cast<float>(double{instance.nearDepth} / instance.scale);
  block.nearRatio = instance.nearRatio;
  const glm::dmat3 rows = glm::transpose(rays.worldFromAsset);
  block.worldX = toFloats(rows[0]);
  block.worldY = toFloats(rows[1]);
  block.worldZ = toFloats(rows[2]);
}

void fillTransients(const ViewBuffers& buffers, const GpuAsset& asset, const VkRect2D& region, gpu::FrameBlock& block) {
  const ViewCapacity& capacity = buffers.capacity();
  block.visibleCapacity =
      static_cast<uint32_t>(std::min(uint64_t{capacity.cells}, capacity.details / asset.detailCount));
  block.planeCapacity = static_cast<uint32_t>(capacity.planes);
  block.pairCapacity = capacity.pairs;
  block.sortRounds = buffers.sortRounds();
  block.groupSums = buffers[ViewBuffer::kGroupSums].address;
  block.visibility = buffers[ViewBuffer::kVisibility].address;
  block.visibleCells = buffers[ViewBuffer::kVisibleCells].address;
  block.cellKeys = buffers[ViewBuffer::kCellKeys].address;
  block.order = buffers[ViewBuffer::kOrder].address;
  block.records = buffers[ViewBuffer::kRecords].address;
  block.planes = buffers[ViewBuffer::kPlanes].address;
  block.details = buffers[ViewBuffer::kDetails].address;
  block.slotTiles = buffers[ViewBuffer::kSlotTiles].address;
  block.tileCounts = buffers[ViewBuffer::kTileCounts].address;
  block.pairTiles = buffers[ViewBuffer::kPairTiles].address;
  block.pairCells = buffers[ViewBuffer::kPairCells].address;
  const bool endsInSwap = tileDigits(tilesOf(region)) % 2 != 0;
  block.tileCells = buffers[endsInSwap ? ViewBuffer::kPairCellsSwap : ViewBuffer::kPairCells].address;
  block.tileLists = buffers[ViewBuffer::kTileLists].address;
  const VkDeviceAddress tallies = buffers[ViewBuffer::kTallies].address;
  const TallyLayout layout = buffers.tallies();
  block.superSums = tallies + layout.superSums;
  block.sizeCounts = tallies + layout.sizeCounts;
  block.tileLengths = tallies + layout.tileLengths;
  block.tileSums = tallies + layout.tileSums;
  block.cellHistogram = tallies + layout.cellHistograms;
  block.pairHistogram = tallies + layout.pairHistograms;
  block.walkStart = buffers[ViewBuffer::kWalkStart].address;
  block.rays = buffers[ViewBuffer::kRays].address;
  block.cones = buffers[ViewBuffer::kCones].address;
}

// Rays lose less than this part of the distance to their own rounding.
constexpr double kBoxGuard = 1e-5;

void fillBox(const GpuAsset& asset, const glm::dvec3& eye, gpu::FrameBlock& block) {
  const glm::dvec3 low = toVector(asset.boundsLow) - eye, high = toVector(asset.boundsHigh) - eye;
  const glm::dvec3 farthest = glm::max(glm::abs(low), glm::abs(high));
  const double guard = kBoxGuard * std::max({farthest.x, farthest.y, farthest.z});
  block.boxLow = toFloats(low - guard);
  block.boxHigh = toFloats(high + guard);
}

// Around the live cells, in the axes of the asset.
PlacedBox boxOf(const GpuChunk& chunk, const glm::dvec3& eye) {
  const glm::dvec3 low = toVector(chunk.liveLow), high = toVector(chunk.liveHigh);
  return {.centre = 0.5 * (low + high) - eye, .half = 0.5 * (high - low)};
}

}  // namespace

// The first 24 bits of a double, all that a float holds. Not by a float and back, which GCC 12 takes for the identity
// where it vectorizes (-O2 and above): low parts were 0.
double leadingBits(double value) {
  constexpr uint64_t kBehindFloat = (uint64_t{1} << 29) - 1;
  return std::bit_cast<double>(std::bit_cast<uint64_t>(value) & ~kBehindFloat);
}

uint32_t fillChunks(const GpuAsset& asset, const glm::dvec3& eye, const RayPyramid& rays, gpu::ChunkEntry* chunks) {
  uint32_t group = 0;
  for (size_t i = 0; i < asset.chunks.size(); ++i) {
    const GpuChunk& chunk = asset.chunks[i];
    const glm::dvec3 offset = glm::dvec3(chunk.origin[0], chunk.origin[1], chunk.origin[2]) - eye;
    const glm::dvec3 high(leadingBits(offset.x), leadingBits(offset.y), leadingBits(offset.z));
    gpu::ChunkEntry& entry = chunks[i];
    entry.offsetHigh = toFloats(high);
    entry.offsetLow = toFloats(offset - high);
    entry.siteRadius = chunk.siteRadius;
    entry.neighbourOffsets = chunk.neighbourOffsets;
    entry.neighbours = chunk.neighbours;
    entry.ghostRefs = chunk.ghostRefs;
    entry.alphaCounts = chunk.alphaCounts;
    entry.cellStarts = chunk.cellStarts;
    entry.cellWords = chunk.cellWords;
    entry.solidBalls = chunk.solidBalls;
    entry.prepared = chunk.prepared;
    entry.hasSolidBalls = chunk.solidBalls != 0;
    entry.cellCount = chunk.cellCount;
    entry.liveCount = chunk.liveCount;
    entry.siteCount = chunk.siteCount;
    entry.neighbourCount = chunk.neighbourCount;
    entry.neighbourShift = chunk.neighbourShift;
    entry.alphaShift = chunk.alphaShift;
    entry.cellWordCount = chunk.cellWordCount;
    entry.firstGroup = group;
    entry.number = chunk.number;
    entry.code = chunk.code;
    entry.lobeTotal = chunk.lobeTotal;
    entry.lobeQuads = chunk.lobeQuads;
    entry.lobesPlaced = 0;
    group += rays.mayMeet(boxOf(chunk, eye)) ? groupsOver(chunk.cellCount, gpu::kGroupSize) : 0;
  }
  return group;
}

uint32_t tilesAlong(uint32_t pixels) { return groupsOver(pixels, gpu::kTileSize); }

uint32_t tilesOf(const VkRect2D& region) { return tilesAlong(region.extent.width) * tilesAlong(region.extent.height); }

void fillOutputs(const FrothRenderInfo& info, gpu::FrameBlock& block) {
  const VkRect2D& region = info.camera.scissor;
  block.scale = 1;
  block.flags = imageFlags(info) | (info.displayCoded ? gpu::kFlagDisplayCoded : 0) |
                static_cast<uint32_t>(info.toneCurve) << gpu::kToneCurveShift |
                (info.tileForm == FROTH_TILE_FORM_ALL_SHORT ? gpu::kFlagShortTiles : 0) |
                (info.tileForm == FROTH_TILE_FORM_ALL_LONG ? gpu::kFlagLongTiles : 0);
  fillDepthRange(info.camera, block);
  block.regionX = static_cast<uint32_t>(region.offset.x);
  block.regionY = static_cast<uint32_t>(region.offset.y);
  block.regionWidth = region.extent.width;
  block.regionHeight = region.extent.height;
}

void fillFrame(RenderMethod method, const FrothRenderInfo& info, const RenderInstance& instance,
               const ViewBuffers& buffers, const RecordingPlace& place, gpu::FrameBlock& block,
               gpu::ChunkEntry* chunks) {
  const GpuAsset& asset = *instance.asset;
  const VkRect2D& region = info.camera.scissor;
  const CameraRays rays = computeCameraRays(info.camera, instance);
  fillOutputs(info, block);
  fillCamera(info, rays, instance, block);
  fillTransients(buffers, asset, region, block);
  const bool isWalk = method == RenderMethod::kWalk;  // lists cells that only guide it, wherever they lie
  block.flags |= isWalk ? gpu::kFlagWalk : 0;
  block.groupCount = fillChunks(asset, rays.eye, isWalk ? RayPyramid() : RayPyramid(info.camera, rays), chunks);
  fillBox(asset, rays.eye, block);
  block.flags |= holdsAllCells(asset, buffers.capacity()) ? 0 : gpu::kFlagCountSizes;
  block.scale = instance.scale;
  block.exposure = instance.exposure;
  block.logCutoff = info.cutoff > 0 ? std::log(info.cutoff) : -std::numeric_limits<float>::infinity();
  block.logQuantile = std::log(info.quantile);
  block.detailSharpness = asset.detailSharpness;
  block.detailCount = asset.detailCount;
  block.lobeCount = asset.lobeCount;
  block.hasHeights = asset.hasHeights;
  block.maxEntries = info.maxEntries;
  block.maxSteps = info.maxSteps;
  block.maxNeighbours = info.maxNeighbours;
  block.localBits = asset.localBits;
  block.tilesX = tilesAlong(region.extent.width);
  block.tilesY = tilesAlong(region.extent.height);
  block.blocksX = groupsOver(block.tilesX, gpu::kBlockTiles);
  block.blocksY = groupsOver(block.tilesY, gpu::kBlockTiles);
  block.chunkCount = static_cast<uint32_t>(asset.chunks.size());
  block.borders = asset.borders;
  block.borderCount = asset.borderCount;
  block.fileChunkCount = asset.fileChunkCount;
  block.firstSlot = asset.firstSlot;
  block.counters = place.counters;
  block.chunks = place.block + kBlockStride;
}

}  // namespace froth
