// A window with its device, swapchain, frames in flight and ImGui: what the loop of an engine stands on.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "host/frame_ring.h"
#include "host/imgui_layer.h"
#include "host/window_system.h"

namespace froth {

// What a program does with its window.
class WindowClient {
 public:
  virtual ~WindowClient() = default;

  virtual Status resize(VkExtent2D extent) = 0;  // the device is done with every frame
  virtual void handleInput(double seconds) = 0;  // since the last time; ImGui knows keys and mouse
  virtual void layOut() = 0;                     // ImGui's windows
  // Leaves picture() in layout GENERAL for blit reads.
  virtual Status record(VkCommandBuffer commands, const FrameRing& frames) = 0;
  virtual const HostImage& picture() const = 0;  // linear light; its size is the window's
};

class AppWindow {
 public:
  // Makes the device too; `options` need not ask for what windows need.
  static Result<std::unique_ptr<AppWindow>> create(const std::string& title, VkExtent2D extent, HostOptions options);
  ~AppWindow();  // what the client made with the device is gone

  // Draws frames until the window is closed, or so many (0: no end). Fails on a validation message.
  Status run(WindowClient& client, uint32_t frames);
  void close();
  Status saveScreenshot(const WindowClient& client, const std::filesystem::path& folder);

  Host& host() { return *host_; }
  VkExtent2D extent() const { return swapchain_->extent(); }

 private:
  AppWindow() = default;
  Status createPresentation();
  Status resize(WindowClient& client);
  Status drawFrame(WindowClient& client);
  void recordBlit(VkCommandBuffer commands, const HostImage& picture, VkImage target) const;

  // Destroyed from the last to the first.
  std::unique_ptr<WindowSystem> system_;
  std::unique_ptr<Host> host_;
  std::unique_ptr<Swapchain> swapchain_;
  std::unique_ptr<FrameRing> frames_;
  std::unique_ptr<ImGuiLayer> imgui_;
  uint32_t screenshots_ = 0;
};

}  // namespace froth
