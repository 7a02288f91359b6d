#include "host/app_window.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "host/picture_file.h"
#include "host/vulkan_check.h"

namespace froth {

Result<std::unique_ptr<AppWindow>> AppWindow::create(const std::string& title, VkExtent2D extent, HostOptions options) {
  std::unique_ptr<AppWindow> app(new AppWindow());
  Result<std::unique_ptr<WindowSystem>> system = WindowSystem::create(title, extent);
  if (!system) return system.error();
  app->system_ = std::move(*system);
  options.instanceExtensions = app->system_->instanceExtensions();
  options.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  Result<std::unique_ptr<Host>> host = Host::create(options);
  if (!host) return host.error();
  app->host_ = std::move(*host);
  if (Status made = app->createPresentation(); !made) return made.error();
  return app;
}

Status AppWindow::createPresentation() {
  if (Status made = system_->createSurface(host_->instance); !made) return made;
  swapchain_ = std::make_unique<Swapchain>(*host_, system_->surface());
  if (Status chosen = swapchain_->chooseFormat(); !chosen) return chosen;
  if (Status sized = swapchain_->resize(system_->framebufferExtent()); !sized) return sized;
  Result<std::unique_ptr<FrameRing>> frames = FrameRing::create(*host_);
  if (!frames) return frames.error();
  frames_ = std::move(*frames);
  Result<std::unique_ptr<ImGuiLayer>> imgui = ImGuiLayer::create(*host_, system_->window(), *swapchain_);
  if (!imgui) return imgui.error();
  imgui_ = std::move(*imgui);
  return {};
}

AppWindow::~AppWindow() {
  if (!host_) return;
  vkDeviceWaitIdle(host_->device);
  imgui_.reset();
  frames_.reset();
  swapchain_.reset();
  system_->destroySurface();
}

Status AppWindow::resize(WindowClient& client) {
  const VkExtent2D extent = system_->framebufferExtent();
  if (extent.width == 0 || extent.height == 0) return {};  // minimized: there is nothing to draw to
  vkDeviceWaitIdle(host_->device);
  if (Status sized = swapchain_->resize(extent); !sized) return sized;
  if (Status set = imgui_->setSwapchain(*swapchain_); !set) return set;
  return client.resize(swapchain_->extent());
}

// The blit to an sRGB format encodes the picture's linear light.
void AppWindow::recordBlit(VkCommandBuffer commands, const HostImage& picture, VkImage target) const {
  imageBarrier(commands, target, {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_NONE},
               {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
  const auto width = static_cast<int32_t>(swapchain_->extent().width);
  const auto height = static_cast<int32_t>(swapchain_->extent().height);
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = {static_cast<int32_t>(picture.extent.width), static_cast<int32_t>(picture.extent.height), 1};
  region.dstOffsets[1] = {width, height, 1};
  vkCmdBlitImage(commands, picture.image, VK_IMAGE_LAYOUT_GENERAL, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                 &region, VK_FILTER_LINEAR);
}

Status AppWindow::drawFrame(WindowClient& client) {
  Result<FrameSlot*> slot = frames_->wait();
  if (!slot) return slot.error();
  uint32_t index = 0;
  const VkResult acquired = vkAcquireNextImageKHR(host_->device, swapchain_->handle(), UINT64_MAX, (*slot)->isAcquired,
                                                  VK_NULL_HANDLE, &index);
  if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return resize(client);  // nothing was acquired; the next turn draws
  if (acquired != VK_SUBOPTIMAL_KHR) {
    if (Status got = checkVulkan(acquired, "vkAcquireNextImageKHR"); !got) return got;
  }
  const SwapchainImage& target = swapchain_->images()[index];

  VkCommandBuffer commands = (*slot)->commands;
  if (Status begun = frames_->begin(**slot); !begun) return begun;
  if (Status recorded = client.record(commands, *frames_); !recorded) return recorded;
  recordBlit(commands, client.picture(), target.image);
  client.layOut();
  imgui_->record(commands, index);
  if (Status submitted = frames_->submit(**slot, target.isDrawn); !submitted) return submitted;

  const VkSwapchainKHR handle = swapchain_->handle();
  VkPresentInfoKHR present{};
  present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  present.waitSemaphoreCount = 1;
  present.pWaitSemaphores = &target.isDrawn;
  present.swapchainCount = 1;
  present.pSwapchains = &handle;
  present.pImageIndices = &index;
  const VkResult presented = vkQueuePresentKHR(host_->queue, &present);
  if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR) return resize(client);
  return checkVulkan(presented, "vkQueuePresentKHR");
}

Status AppWindow::saveScreenshot(const WindowClient& client, const std::filesystem::path& folder) {
  vkDeviceWaitIdle(host_->device);
  const HostImage& picture = client.picture();
  const Result<std::vector<float>> texels = host_->readImage(picture);
  if (!texels) return texels.error();
  char name[48];
  std::snprintf(name, sizeof(name), "screenshot_%02u.png", screenshots_++);
  const std::filesystem::path path = folder / name;
  if (Status written = writePicture(path, encodePicture(*texels, picture.extent)); !written) return written;
  std::printf("%s\n", path.c_str());
  return {};
}

void AppWindow::close() { glfwSetWindowShouldClose(system_->window(), GLFW_TRUE); }

Status AppWindow::run(WindowClient& client, uint32_t frames) {
  using Clock = std::chrono::steady_clock;
  if (Status sized = client.resize(swapchain_->extent()); !sized) return sized;
  Clock::time_point last = Clock::now();
  for (uint32_t frame = 0; frames == 0 || frame < frames; ++frame) {
    glfwPollEvents();
    const VkExtent2D extent = system_->framebufferExtent();
    if (glfwWindowShouldClose(system_->window())) break;
    if (extent.width == 0 || extent.height == 0) {
      glfwWaitEvents();  // minimized
      continue;
    }
    const Clock::time_point now = Clock::now();
    imgui_->beginFrame();
    client.handleInput(std::chrono::duration<double>(now - std::exchange(last, now)).count());
    if (Status drawn = drawFrame(client); !drawn) return drawn;
    ImGui::EndFrame();  // does nothing if the frame was drawn; else closes what no one rendered
  }
  return host_->checkSilence();
}

}  // namespace froth
