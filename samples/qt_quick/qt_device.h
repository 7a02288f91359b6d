// The VkDevice that Qt draws with.
//
// Qt 6.4 makes its own VkDevice with the features of Vulkan 1.0 alone, and lets an application choose extensions but no
// features. Froth needs bufferDeviceAddress and synchronization2. So the sample creates the VkDevice and hands it to Qt
// (QQuickGraphicsDevice::fromDeviceObjects). All else is Qt's: instance, queue, swapchain, frames, command buffers,
// submission.
#pragma once

#include <vulkan/vulkan.h>  // before Qt's headers, which would include it without prototypes

#include <QQuickGraphicsDevice>
#include <QVulkanInstance>
#include <QWindow>

#include <memory>
#include <string>

#include "base/result.h"
#include "froth/froth.h"

namespace froth {

class QtDevice {
 public:
  // `window` has its platform window (QWindow::create) and `instance`. `wanted`: as HostOptions::device.
  static Result<std::unique_ptr<QtDevice>> create(QVulkanInstance& instance, QWindow& window,
                                                  const std::string& wanted);
  ~QtDevice();  // after all windows that draw with it
  QtDevice(const QtDevice&) = delete;
  QtDevice& operator=(const QtDevice&) = delete;

  QQuickGraphicsDevice forQt() const;
  FrothContextInfo contextInfo() const;  // for frothCreateContext, without callbacks and frames in flight

 private:
  QtDevice() = default;
  Status chooseFeatures();
  Status createDevice();

  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  uint32_t queueFamily_ = 0;
  VkPhysicalDeviceFeatures2 features_{};
  VkPhysicalDeviceVulkan12Features features12_{};
  VkPhysicalDeviceVulkan13Features features13_{};
};

}  // namespace froth
