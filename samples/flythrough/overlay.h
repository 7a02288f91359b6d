// Dear ImGui over the picture: what Froth did in the newest complete frames, and the keys.
#pragma once

#include <memory>
#include <vector>

#include "samples/flythrough/pass_history.h"
#include "samples/flythrough/scene.h"
#include "samples/flythrough/swapchain.h"

struct GLFWwindow;

namespace froth {

struct OverlayContent {
  const char* picture = "";  // "raster", "walk", "difference"
  const char* camera = "";   // "path", "free flight"
  FrothAssetStatus asset{};
  FrothFrameStatus frame{};
  FrothViewStatus view{};
};

class Overlay {
 public:
  static Result<std::unique_ptr<Overlay>> create(Host& host, GLFWwindow* window, const Swapchain& swapchain);
  ~Overlay();  // the device is done with it

  Status setSwapchain(const Swapchain& swapchain);  // after a resize; the device is done with the old images

  // Starts ImGui's frame: from here on ImGui knows keys and mouse. Once per recorded frame.
  void beginFrame();
  void layOut(const OverlayContent& content);
  // Draws over image `index`, which is in TRANSFER_DST_OPTIMAL after a blit; leaves it ready to present.
  void record(VkCommandBuffer commands, uint32_t index);

 private:
  Overlay(Host& host, VkExtent2D extent) : host_(host), extent_(extent) {}
  Status createRenderPass(VkFormat format);
  Status startImGui(GLFWwindow* window, uint32_t imageCount);
  void destroyFramebuffers();

  Host& host_;
  VkExtent2D extent_;
  PassHistory history_;
  bool isStarted_ = false;
  VkRenderPass renderPass_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::vector<VkFramebuffer> framebuffers_;
};

}  // namespace froth
