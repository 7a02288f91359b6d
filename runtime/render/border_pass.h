// Tells walks where the border cells of drawn chunks are (shaders/publish_borders.comp).
#pragma once

#include "runtime/asset/chunk_slots.h"
#include "runtime/render/pipelines.h"

namespace froth {

// Before the walks of a frame. Walks of earlier frames read the same table: they are before it in the order of
// submission, on one queue or behind a semaphore, and the commands wait for them. Nothing to tell records nothing.
void recordBorders(const Device& device, RenderPipelines& pipelines, VkCommandBuffer commandBuffer,
                   const GpuAsset& asset, const ChunkSlots::Publication& publication);

}  // namespace froth
