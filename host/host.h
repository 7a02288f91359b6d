// A stand-in for an engine: instance, device, queues, images, submission, read-back; no window.
// Used by the samples, by `froth render` and `froth bench`, and by the GPU tests. Links the Vulkan loader.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/result.h"
#include "froth/froth.h"

namespace froth {

struct HostDeviceInfo {
  std::string name, driver;
  uint32_t apiVersion = 0;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  bool isSuitable = false;  // frothGetRequirements is satisfied
  std::string missing;      // what it lacks
};

Result<std::vector<HostDeviceInfo>> listHostDevices();

void recordMemoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess,
                         VkPipelineStageFlags2 toStage, VkAccessFlags2 toAccess);

struct HostOptions {
  std::string device;           // index or part of a name; empty: first suitable, GPUs before CPUs
  bool useValidation = false;   // core and synchronization validation; fails if the layer is not installed
  bool useGraphics = false;     // dynamic rendering into images; a queue family with graphics
  bool useOtherQueues = false;  // Host::computeQueue and uploadQueue of families of their own; timeline semaphores
  // What a window needs, if the caller makes one; names live as long as the call.
  std::vector<const char*> instanceExtensions = {};
  std::vector<const char*> deviceExtensions = {};
};

struct HostQueue {
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
};

struct HostImage {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkExtent2D extent{};
};

struct HostBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* mapped = nullptr;       // host-visible and coherent, of the device's own memory where it has such
  VkDeviceAddress address = 0;  // with usage SHADER_DEVICE_ADDRESS
};

class Host {
 public:
  static Result<std::unique_ptr<Host>> create(const HostOptions& options);
  ~Host();

  FrothContextInfo contextInfo() const;  // ready for frothCreateContext; callbacks left null
  // TRANSFER_SRC | TRANSFER_DST | SAMPLED, and STORAGE; of depth formats DEPTH_STENCIL_ATTACHMENT and a view of the
  // depth; with useGraphics of all others COLOR_ATTACHMENT.
  // The view is of the first of the layers.
  Result<HostImage> createImage(VkFormat format, VkExtent2D extent, uint32_t layers = 1);
  void destroyImage(HostImage& image);
  Result<HostBuffer> createBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage);
  void destroyBuffer(HostBuffer& buffer);
  FrothImage describe(const HostImage& image) const;  // UNDEFINED in, GENERAL out to a transfer read

  // Records, submits and waits. `record` gets the command buffer and the frame's serial (completedSerial is serial -
  // 1).
  Status submit(const std::function<Status(VkCommandBuffer, uint64_t serial)>& record);
  uint64_t nextSerial() const;

  // Texels of an image in layout GENERAL as floats, `channels` per texel (1, 2 or 4), halves and depths of 16 bits
  // widened; integers and packed colours as the bits of floats.
  Result<std::vector<float>> readImage(const HostImage& image, uint32_t layer = 0);
  // Fills an image of floats or depths, `channels` values per texel; it is in layout GENERAL then.
  Status writeImage(const HostImage& image, const std::vector<float>& texels);
  // The same image as an input that keeps its contents and its layout GENERAL.
  FrothImage describeInput(const HostImage& image) const;

  // Messages of the validation layers so far (severity warning or error); tests expect none.
  std::vector<std::string> validationMessages() const;
  void forgetValidationMessages();
  Status checkSilence() const;  // an error with the first of them, if there is any

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  // With HostOptions::useOtherQueues of a family with compute and without graphics, and of one that copies and can do
  // neither; where the device lacks such a family, and else, `queue`.
  HostQueue computeQueue, uploadQueue;
  HostDeviceInfo info;

 private:
  Host();
  void chooseFamilies(const HostOptions& options);
  Status createDevice(const HostOptions& options);
  Status createCommands();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace froth
