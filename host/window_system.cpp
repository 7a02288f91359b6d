#include "host/window_system.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "host/vulkan_check.h"

namespace froth {
namespace {

Error glfwError(const char* call) {
  const char* text = nullptr;
  glfwGetError(&text);
  return makeError(ErrorKind::kUnsupported, "%s: %s; use --headless where there is no display", call,
                   text ? text : "no Vulkan surface here");
}

}  // namespace

Result<std::unique_ptr<WindowSystem>> WindowSystem::create(const std::string& title, VkExtent2D extent) {
  if (!glfwInit()) return glfwError("glfwInit");
  std::unique_ptr<WindowSystem> system(new WindowSystem());
  if (!glfwVulkanSupported()) return glfwError("glfwVulkanSupported");
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  system->window_ = glfwCreateWindow(static_cast<int>(extent.width), static_cast<int>(extent.height), title.c_str(),
                                     nullptr, nullptr);
  if (!system->window_) return glfwError("glfwCreateWindow");
  return system;
}

WindowSystem::~WindowSystem() {
  if (window_) glfwDestroyWindow(window_);
  glfwTerminate();
}

std::vector<const char*> WindowSystem::instanceExtensions() const {
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return names ? std::vector<const char*>(names, names + count) : std::vector<const char*>();
}

Status WindowSystem::createSurface(VkInstance instance) {
  instance_ = instance;
  return checkVulkan(glfwCreateWindowSurface(instance, window_, nullptr, &surface_), "glfwCreateWindowSurface");
}

void WindowSystem::destroySurface() {
  if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
  surface_ = VK_NULL_HANDLE;
}

VkExtent2D WindowSystem::framebufferExtent() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

}  // namespace froth
