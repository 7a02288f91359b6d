// Fills what the passes of one recording read: camera, limits, addresses, chunk table.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "froth/froth.h"
#include "runtime/render/placed_box.h"
#include "runtime/render/view_buffers.h"
#include "runtime/render/view_renderer.h"
#include "shaders/gpu/layout.h"

namespace froth {

// Where one recording keeps its block and its counters.
struct RecordingPlace {
  VkDeviceAddress block;     // FrameBlock; the chunk table follows at kBlockStride
  VkDeviceAddress counters;  // Counters
};

// Tiles over a region.
uint32_t tilesAlong(uint32_t pixels);

uint32_t tilesOf(const VkRect2D& region);

// The chunk table of an asset as seen from a point of its axes. chunks: [asset.chunks.size()]. Returns how many
// workgroups its cells have: those of chunks whose live cells the rays, in the same axes, may meet.
uint32_t fillChunks(const GpuAsset& asset, const glm::dvec3& eye, const RayPyramid& rays, gpu::ChunkEntry* chunks);

// What a clear needs: region, outputs, scale.
void fillOutputs(const FrothRenderInfo& info, gpu::FrameBlock& block);

// Everything. chunks: [asset.chunks.size()].
void fillFrame(RenderMethod method, const FrothRenderInfo& info, const RenderInstance& instance,
               const ViewBuffers& buffers, const RecordingPlace& place, gpu::FrameBlock& block,
               gpu::ChunkEntry* chunks);

}  // namespace froth
