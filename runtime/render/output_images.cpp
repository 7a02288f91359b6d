#include "runtime/render/output_images.h"

#include "runtime/render/image_barriers.h"
#include "runtime/render/pipeline_state.h"

namespace froth {
namespace {

constexpr const char* kOutputImages = "output images of a view";

const ImageUse& useOf(const FrameImage& image) {
  return image.role == ImageRole::kRead ? kImageSampled : kImageWritten;
}

template <class Visitor>
void forEachImage(const FrothRenderInfo& info, Visitor&& visit) {
  for (const FrameImage& image : kFrameImages) {
    if (image.of(info).image) visit(image.of(info), useOf(image));
  }
}

// A placeholder has no contents to keep: any earlier layout will do.
VkImageMemoryBarrier2 placeholderBarrier(VkImage image) {
  VkImageMemoryBarrier2 barrier = barrierOf(image);
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  return barrier;
}

}  // namespace

const OutputImages::Placeholder& OutputImages::placeholderOf(const FrameImage& image) const {
  if (image.role == ImageRole::kRead) return input_;
  return image.formats.front() == VK_FORMAT_R16G16B16A16_SFLOAT ? half4_ : float1_;
}

Result<std::unique_ptr<OutputImages>> OutputImages::create(Device& device, uint32_t recordings) {
  std::unique_ptr<OutputImages> images(new OutputImages(device));
  if (const Status status = images->createPlaceholders(); !status) return status.error();
  Result<std::unique_ptr<DescriptorSets>> sets =
      DescriptorSets::create(device, kOutputImages, outputBindings(), recordings);
  if (!sets) return sets.error();
  images->sets_ = std::move(*sets);
  return images;
}

OutputImages::~OutputImages() {
  const DeviceTable& vk = device_.table;
  for (Placeholder* placeholder : placeholders()) {
    vk.vkDestroyImageView(device_.device, placeholder->view, nullptr);
    vk.vkDestroyImage(device_.device, placeholder->image, nullptr);
  }
  device_.release(memory_);
}

Status OutputImages::createPlaceholders() {
  VkMemoryRequirements all = kNoRequirements;
  for (Placeholder* placeholder : placeholders()) {
    if (const Status status = createImage(*placeholder, all); !status) return status;
  }
  const Result<MemoryBlock> memory = device_.allocate(
      all, all.size, {MemoryUse::kViews, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0, kOutputImages, false});
  if (!memory) return memory.error();
  memory_ = *memory;
  for (Placeholder* placeholder : placeholders()) {
    if (const Status status = bindImage(*placeholder); !status) return status;
  }
  return {};
}

Status OutputImages::createImage(Placeholder& placeholder, VkMemoryRequirements& all) {
  const DeviceTable& vk = device_.table;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = placeholder.format;
  info.extent = {1, 1, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = placeholder.usage;
  const Result<VkImage> image = device_.create(VK_OBJECT_TYPE_IMAGE, kOutputImages, vk.vkCreateImage, info);
  if (!image) return image.error();
  placeholder.image = *image;
  VkMemoryRequirements own{};
  vk.vkGetImageMemoryRequirements(device_.device, placeholder.image, &own);
  placeholder.offset = append(own, all);
  return {};
}

Status OutputImages::bindImage(Placeholder& placeholder) {
  const DeviceTable& vk = device_.table;
  const VkResult result = vk.vkBindImageMemory(device_.device, placeholder.image, memory_.place.memory,
                                               memory_.place.offset + placeholder.offset);
  if (result != VK_SUCCESS) return device_.explain(result, "%s: vkBindImageMemory", kOutputImages);
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = placeholder.image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = placeholder.format;
  info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  const Result<VkImageView> view = device_.create(VK_OBJECT_TYPE_IMAGE_VIEW, kOutputImages, vk.vkCreateImageView, info);
  if (!view) return view.error();
  placeholder.view = *view;
  return {};
}

VkDescriptorSet OutputImages::update(uint32_t recording, const FrothRenderInfo& info) {
  std::array<VkDescriptorImageInfo, gpu::kBindingCount> images{};
  std::array<VkWriteDescriptorSet, gpu::kBindingCount> writes{};
  for (uint32_t i = 0; i < gpu::kBindingCount; ++i) {
    const FrameImage& image = boundImages()[i];
    const FrothImage& given = image.of(info);
    images[i] = given.image ? VkDescriptorImageInfo{VK_NULL_HANDLE, given.view, useOf(image).layout}
                            : VkDescriptorImageInfo{VK_NULL_HANDLE, placeholderOf(image).view, VK_IMAGE_LAYOUT_GENERAL};
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = (*sets_)[recording];
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = descriptorTypeOf(image);
    writes[i].pImageInfo = &images[i];
  }
  device_.table.vkUpdateDescriptorSets(device_.device, gpu::kBindingCount, writes.data(), 0, nullptr);
  return (*sets_)[recording];
}

void OutputImages::enter(VkCommandBuffer commandBuffer, const FrothRenderInfo& info) const {
  // Uploads of this frame, and every use of the transients by earlier recordings.
  VkMemoryBarrier2 memory{};
  memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                        VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
  memory.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  memory.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  std::array<VkImageMemoryBarrier2, kFrameImageCount + 3> barriers{};
  uint32_t count = 0;
  forEachImage(info,
               [&](const FrothImage& image, const ImageUse& use) { barriers[count++] = entryBarrier(image, use); });
  for (const Placeholder* placeholder : {&half4_, &float1_, &input_}) {
    barriers[count++] = placeholderBarrier(placeholder->image);
  }

  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &memory;
  dependency.imageMemoryBarrierCount = count;
  dependency.pImageMemoryBarriers = barriers.data();
  device_.table.vkCmdPipelineBarrier2(commandBuffer, &dependency);
}

void OutputImages::leave(VkCommandBuffer commandBuffer, const FrothRenderInfo& info) const {
  std::array<VkImageMemoryBarrier2, kFrameImageCount> barriers{};
  uint32_t count = 0;
  forEachImage(info,
               [&](const FrothImage& image, const ImageUse& use) { barriers[count++] = exitBarrier(image, use); });
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = count;
  dependency.pImageMemoryBarriers = barriers.data();
  device_.table.vkCmdPipelineBarrier2(commandBuffer, &dependency);
}

}  // namespace froth
