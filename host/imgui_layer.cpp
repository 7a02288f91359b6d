#include "host/imgui_layer.h"

#include <cmath>
#include <cstdio>

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include "host/vulkan_check.h"

namespace froth {
namespace {

constexpr float kBarWidth = 300.0f;  // [pixels]

// ImGui's colours are display-coded, but the swapchain's sRGB format encodes once more: hand it linear ones.
void decodeStyleColours() {
  for (ImVec4& colour : ImGui::GetStyle().Colors) {
    colour = ImVec4(std::pow(colour.x, 2.2f), std::pow(colour.y, 2.2f), std::pow(colour.z, 2.2f), colour.w);
  }
}

}  // namespace

Result<std::unique_ptr<ImGuiLayer>> ImGuiLayer::create(Host& host, GLFWwindow* window, const Swapchain& swapchain) {
  std::unique_ptr<ImGuiLayer> layer(new ImGuiLayer(host, swapchain.extent()));
  if (Status made = layer->createRenderPass(swapchain.format()); !made) return made.error();
  const uint32_t imageCount = static_cast<uint32_t>(swapchain.images().size());
  if (Status started = layer->startImGui(window, imageCount); !started) return started.error();
  if (Status set = layer->setSwapchain(swapchain); !set) return set.error();
  return layer;
}

ImGuiLayer::~ImGuiLayer() {
  if (isStarted_) {
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  destroyFramebuffers();
  vkDestroyDescriptorPool(host_.device, pool_, nullptr);
  vkDestroyRenderPass(host_.device, renderPass_, nullptr);
}

Status ImGuiLayer::createRenderPass(VkFormat format) {
  VkAttachmentDescription attachment{};
  attachment.format = format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.initialLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  attachment.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkSubpassDependency afterBlit{};
  afterBlit.srcSubpass = VK_SUBPASS_EXTERNAL;
  afterBlit.srcStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
  afterBlit.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  afterBlit.dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  afterBlit.dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 1;
  info.pDependencies = &afterBlit;
  return checkVulkan(vkCreateRenderPass(host_.device, &info, nullptr, &renderPass_), "vkCreateRenderPass");
}

Status ImGuiLayer::startImGui(GLFWwindow* window, uint32_t imageCount) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};  // the font
  VkDescriptorPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  poolInfo.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  Status made = checkVulkan(vkCreateDescriptorPool(host_.device, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
  if (!made) return made;

  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // a sample leaves no files behind
  ImGui::StyleColorsDark();
  decodeStyleColours();
  ImGui_ImplGlfw_InitForVulkan(window, true);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = host_.instance;
  info.PhysicalDevice = host_.physicalDevice;
  info.Device = host_.device;
  info.QueueFamily = host_.queueFamily;
  info.Queue = host_.queue;
  info.DescriptorPool = pool_;
  info.MinImageCount = 2;
  info.ImageCount = imageCount;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  ImGui_ImplVulkan_Init(&info, renderPass_);
  isStarted_ = true;

  Status uploaded = host_.submit([](VkCommandBuffer commands, uint64_t) -> Status {
    if (ImGui_ImplVulkan_CreateFontsTexture(commands)) return {};
    return makeError(ErrorKind::kUnsupported, "ImGui could not make its font texture");
  });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
  return uploaded;
}

Status ImGuiLayer::setSwapchain(const Swapchain& swapchain) {
  destroyFramebuffers();
  extent_ = swapchain.extent();
  for (const SwapchainImage& image : swapchain.images()) {
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = renderPass_;
    info.attachmentCount = 1;
    info.pAttachments = &image.view;
    info.width = extent_.width;
    info.height = extent_.height;
    info.layers = 1;
    VkFramebuffer& framebuffer = framebuffers_.emplace_back();
    Status made = checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
    if (!made) return made;
  }
  return {};
}

void ImGuiLayer::destroyFramebuffers() {
  for (const VkFramebuffer framebuffer : framebuffers_) vkDestroyFramebuffer(host_.device, framebuffer, nullptr);
  framebuffers_.clear();
}

void ImGuiLayer::beginFrame() {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void ImGuiLayer::record(VkCommandBuffer commands, uint32_t index) {
  ImGui::Render();
  VkRenderPassBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  info.renderPass = renderPass_;
  info.framebuffer = framebuffers_[index];
  info.renderArea = {{0, 0}, extent_};
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
  vkCmdEndRenderPass(commands);
}

void layOutPassTimes(const PassHistory& history) {
  const Percentiles total = history.total();
  ImGui::Text("GPU %.3f ms [p5 %.3f, p95 %.3f]", total.median, total.p5, total.p95);
  for (const PassHistory::Row& pass : history.passes()) {
    const float share = total.median > 0 ? static_cast<float>(pass.times.median / total.median) : 0.0f;
    char label[96];
    std::snprintf(label, sizeof(label), "%s %.3f ms [%.3f, %.3f]", pass.name, pass.times.median, pass.times.p5,
                  pass.times.p95);
    ImGui::ProgressBar(share, ImVec2(kBarWidth, 0), label);
  }
}

}  // namespace froth
