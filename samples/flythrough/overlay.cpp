#include "samples/flythrough/overlay.h"

#include <cmath>
#include <cstdio>
#include <span>

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include "samples/flythrough/vulkan_check.h"

namespace froth {
namespace {

constexpr double kMebi = 1024.0 * 1024.0;
constexpr float kBarWidth = 300.0f;  // [pixels]

// ImGui's colours are display-coded, but the swapchain's sRGB format encodes once more: hand it linear ones.
void decodeStyleColours() {
  for (ImVec4& colour : ImGui::GetStyle().Colors) {
    colour = ImVec4(std::pow(colour.x, 2.2f), std::pow(colour.y, 2.2f), std::pow(colour.z, 2.2f), colour.w);
  }
}

void layOutPasses(const PassHistory& history) {
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

void layOutParts(const char* owner, uint64_t sum, std::span<const FrothMemory> parts) {
  const double bytes = static_cast<double>(sum);
  if (!ImGui::TreeNode(owner, "%s %.1f MiB", owner, bytes / kMebi)) return;
  for (const FrothMemory& part : parts)
    ImGui::Text("%8.2f  %s", static_cast<double>(part.bytes) / kMebi, part.name);
  ImGui::TreePop();
}

// Counts are zero unless asked for (--counters).
void layOutWork(const FrothWork& work, VkExtent2D extent) {
  if (work.ballHits == 0) return;
  const double rays = static_cast<double>(extent.width) * extent.height;
  const auto perRay = [&](uint64_t count) { return static_cast<double>(count) / rays; };
  ImGui::Text("per ray  %.2f balls, %.2f planes, %.2f heights, %.2f colours", perRay(work.ballHits),
              perRay(work.planes), perRay(work.heights), perRay(work.colours));
  ImGui::Text("         %.2f steps, %.2f neighbours", perRay(work.steps), perRay(work.neighbours));
}

void layOutWarnings(const FrothViewStatus& view) {
  if (view.bits & FROTH_VIEW_CELL_OVERFLOW) ImGui::TextUnformatted("cells overflowed: buffers grow");
  if (view.bits & FROTH_VIEW_PAIR_OVERFLOW) ImGui::TextUnformatted("pairs overflowed: buffers grow");
  if (view.bits & FROTH_VIEW_STEP_LIMIT) ImGui::TextUnformatted("walks hit the step limit");
  if (view.bits & FROTH_VIEW_NO_WALK_GRAPH) ImGui::TextUnformatted("the asset has no walk graph");
}

}  // namespace

Result<std::unique_ptr<Overlay>> Overlay::create(Host& host, GLFWwindow* window, const Swapchain& swapchain) {
  std::unique_ptr<Overlay> overlay(new Overlay(host, swapchain.extent()));
  if (Status made = overlay->createRenderPass(swapchain.format()); !made) return made.error();
  const uint32_t imageCount = static_cast<uint32_t>(swapchain.images().size());
  if (Status started = overlay->startImGui(window, imageCount); !started) return started.error();
  if (Status set = overlay->setSwapchain(swapchain); !set) return set.error();
  return overlay;
}

Overlay::~Overlay() {
  if (isStarted_) {
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  destroyFramebuffers();
  vkDestroyDescriptorPool(host_.device, pool_, nullptr);
  vkDestroyRenderPass(host_.device, renderPass_, nullptr);
}

Status Overlay::createRenderPass(VkFormat format) {
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

Status Overlay::startImGui(GLFWwindow* window, uint32_t imageCount) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};  // the font
  VkDescriptorPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  poolInfo.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  poolInfo.maxSets = 1;
  poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &size;
  Status made =
      checkVulkan(vkCreateDescriptorPool(host_.device, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
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

Status Overlay::setSwapchain(const Swapchain& swapchain) {
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
    Status made =
        checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
    if (!made) return made;
  }
  return {};
}

void Overlay::destroyFramebuffers() {
  for (const VkFramebuffer framebuffer : framebuffers_)
    vkDestroyFramebuffer(host_.device, framebuffer, nullptr);
  framebuffers_.clear();
}

void Overlay::beginFrame() {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Overlay::layOut(const OverlayContent& content) {
  ImGui::SetNextWindowPos(ImVec2(12, 12), ImGuiCond_FirstUseEver);
  ImGui::Begin("Froth", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::Text("%s, %s, %.1f frames/s", content.picture, content.camera, ImGui::GetIO().Framerate);
  if (content.asset.state == FROTH_ASSET_OPENING) {
    ImGui::Text("loading, %.1f MiB to go", static_cast<double>(content.frame.uploadBytesQueued) / kMebi);
  }
  history_.add(content.view);
  layOutPasses(history_);
  ImGui::Separator();
  ImGui::Text("cells    %u drawn, %u live, %u in all", content.view.visibleCells, content.asset.liveCount,
              content.asset.cellCount);
  ImGui::Text("pairs    %llu", static_cast<unsigned long long>(content.view.pairs));
  layOutWork(content.view.work, extent_);
  ImGui::Text("memory   device %.1f MiB, host %.1f MiB", static_cast<double>(content.frame.deviceBytes) / kMebi,
              static_cast<double>(content.frame.hostBytes) / kMebi);
  layOutParts("asset", content.asset.deviceBytes, {content.asset.memory, content.asset.memoryCount});
  layOutParts("view", content.view.deviceBytes, {content.view.memory, content.view.memoryCount});
  layOutWarnings(content.view);
  ImGui::Separator();
  ImGui::TextUnformatted(
      "1 raster  2 walk  3 difference x 32\n"
      "W A S D Q E fly, drag to look, wheel: speed\n"
      "P path or free flight  C screenshot\n"
      "H hide this  Esc quit");
  ImGui::End();
}

void Overlay::record(VkCommandBuffer commands, uint32_t index) {
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

}  // namespace froth
