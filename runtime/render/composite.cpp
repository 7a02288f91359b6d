#include "runtime/render/composite.h"

#include <algorithm>
#include <array>

#include "runtime/render/image_barriers.h"
#include "runtime/render/view_capacity.h"
#include "shaders/gpu/layout.h"
#include "spirv/composite_r11f_g11f_b10f.h"
#include "spirv/composite_rgba16f.h"
#include "spirv/composite_rgba32f.h"

namespace froth {
namespace {

constexpr ImageUse kImageBlended = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                    VK_IMAGE_LAYOUT_GENERAL};

std::span<const uint32_t> codeOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return composite_rgba16f_spirv;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return composite_rgba32f_spirv;
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
      return composite_r11f_g11f_b10f_spirv;
    default:
      return {};
  }
}

// Of the images that are given, from `before` or to `after` their use.
template <class Barrier>
void recordBarriers(const DeviceTable& vk, VkCommandBuffer commandBuffer, const FrothCompositeInfo& info,
                    Barrier barrierOf) {
  std::array<VkImageMemoryBarrier2, 3> barriers{};
  uint32_t count = 0;
  barriers[count++] = barrierOf(info.target, kImageBlended);
  barriers[count++] = barrierOf(info.foam, kImageSampled);
  if (info.shadowFactor.image) barriers[count++] = barrierOf(info.shadowFactor, kImageSampled);
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = count;
  dependency.pImageMemoryBarriers = barriers.data();
  vk.vkCmdPipelineBarrier2(commandBuffer, &dependency);
}

}  // namespace

SetBindings compositeBindings() {
  return {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}};
}

bool canComposite(VkFormat format) { return !codeOf(format).empty(); }

Result<std::unique_ptr<ImagePass>> createCompositePass(Device& device, VkPipelineCache cache, VkFormat format) {
  return ImagePass::create(device, cache,
                           {"composite", codeOf(format), compositeBindings(), sizeof(gpu::CompositeConstants)});
}

void recordComposite(const DeviceTable& vk, VkCommandBuffer commandBuffer, const ImagePass& pass,
                     const DescriptorSets& sets, uint32_t set, const FrothCompositeInfo& info, const VkRect2D& region) {
  const gpu::CompositeConstants constants{static_cast<uint32_t>(region.offset.x),
                                          static_cast<uint32_t>(region.offset.y), region.extent.width,
                                          region.extent.height, info.shadowFactor.image != nullptr};
  const VkImageView shadow = info.shadowFactor.image ? info.shadowFactor.view : info.foam.view;  // bound, and not read
  const VkDescriptorImageInfo images[] = {{VK_NULL_HANDLE, info.target.view, kImageBlended.layout},
                                          {VK_NULL_HANDLE, info.foam.view, kImageSampled.layout},
                                          {VK_NULL_HANDLE, shadow, kImageSampled.layout}};
  vk.beginLabel(commandBuffer, "froth composite");
  recordBarriers(vk, commandBuffer, info, entryBarrier);
  pass.bind(commandBuffer, sets.update(set, images), std::as_bytes(std::span(&constants, 1)));
  vk.vkCmdDispatch(commandBuffer, groupsOver(region.extent.width, gpu::kSubTileSize),
                   groupsOver(region.extent.height, gpu::kSubTileSize), 1);
  recordBarriers(vk, commandBuffer, info, exitBarrier);
  vk.endLabel(commandBuffer);
}

}  // namespace froth
