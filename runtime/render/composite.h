// The foam's colour over the engine's.
#pragma once

#include "froth/froth_composite.h"
#include "runtime/render/image_pass.h"

namespace froth {

SetBindings compositeBindings();

// Whether there is a pass for the engine's format.
bool canComposite(VkFormat format);

Result<std::unique_ptr<ImagePass>> createCompositePass(Device& device, VkPipelineCache cache, VkFormat format);

// info has been checked. region: what was drawn. set: one of compositeBindings(), free for this frame.
void recordComposite(const DeviceTable& vk, VkCommandBuffer commandBuffer, const ImagePass& pass,
                     const DescriptorSets& sets, uint32_t set, const FrothCompositeInfo& info, const VkRect2D& region);

}  // namespace froth
