// GLFW's window and its surface, as objects that clean up after themselves.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/host.h"

struct GLFWwindow;

namespace froth {

class WindowSystem {
 public:
  static Result<std::unique_ptr<WindowSystem>> create(const std::string& title, VkExtent2D extent);
  ~WindowSystem();

  std::vector<const char*> instanceExtensions() const;
  Status createSurface(VkInstance instance);  // once
  void destroySurface();                      // before the instance goes

  VkExtent2D framebufferExtent() const;  // [pixels]; zero while minimized
  GLFWwindow* window() const { return window_; }
  VkSurfaceKHR surface() const { return surface_; }

 private:
  WindowSystem() = default;

  GLFWwindow* window_ = nullptr;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

}  // namespace froth
