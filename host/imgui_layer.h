// Dear ImGui, drawn over the image that a swapchain presents.
#pragma once

#include <memory>
#include <vector>

#include "host/pass_history.h"
#include "host/swapchain.h"

struct GLFWwindow;

namespace froth {

class ImGuiLayer {
 public:
  static Result<std::unique_ptr<ImGuiLayer>> create(Host& host, GLFWwindow* window, const Swapchain& swapchain);
  ~ImGuiLayer();  // the device is done with it

  Status setSwapchain(const Swapchain& swapchain);  // after a resize; the device is done with the old images

  // Starts ImGui's frame: from here on ImGui knows keys and mouse. Once per recorded frame.
  void beginFrame();
  // Draws over image `index`, which is in TRANSFER_DST_OPTIMAL after a blit; leaves it ready to present.
  void record(VkCommandBuffer commands, uint32_t index);

 private:
  ImGuiLayer(Host& host, VkExtent2D extent) : host_(host), extent_(extent) {}
  Status createRenderPass(VkFormat format);
  Status startImGui(GLFWwindow* window, uint32_t imageCount);
  void destroyFramebuffers();

  Host& host_;
  VkExtent2D extent_;
  bool isStarted_ = false;
  VkRenderPass renderPass_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::vector<VkFramebuffer> framebuffers_;
};

// A bar for each pass; within an ImGui window.
void layOutPassTimes(const PassHistory& history);

}  // namespace froth
