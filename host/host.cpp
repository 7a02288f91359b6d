#include "host/host.h"

#include <set>

#include "host/host_instance.h"
#include "host/host_state.h"

namespace froth {
namespace {

// The first family that can do what is wanted and nothing that is not; else `otherwise`.
uint32_t findQueueFamily(VkPhysicalDevice physicalDevice, VkQueueFlags wanted, VkQueueFlags unwanted,
                         uint32_t otherwise) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, families.data());
  for (uint32_t family = 0; family < count; ++family) {
    if ((families[family].queueFlags & (wanted | unwanted)) == wanted) return family;
  }
  return otherwise;
}

Status failed(const char* call, VkResult code) {
  return makeError(ErrorKind::kUnsupported, "%s gives VkResult %d", call, code);
}

}  // namespace

Result<std::vector<HostDeviceInfo>> listHostDevices() {
  Result<HostInstance> instance = createHostInstance(nullptr, {});
  if (!instance) {
    return instance.error();
  }
  const Result<std::vector<HostDeviceChoice>> devices = enumerateHostDevices(instance->instance);
  destroyHostInstance(*instance);
  if (!devices) {
    return devices.error();
  }
  std::vector<HostDeviceInfo> infos;
  for (const HostDeviceChoice& device : *devices) {
    infos.push_back(device.info);
  }
  return infos;
}

Host::Host() : state_(std::make_unique<State>()) {}

Result<std::unique_ptr<Host>> Host::create(const HostOptions& options) {
  std::unique_ptr<Host> host(new Host());
  State& state = *host->state_;
  Result<HostInstance> instance =
      createHostInstance(options.useValidation ? &state.log : nullptr, options.instanceExtensions);
  if (!instance) {
    return instance.error();
  }
  state.instance = *instance;
  host->instance = instance->instance;
  const Result<std::vector<HostDeviceChoice>> devices = enumerateHostDevices(host->instance);
  if (!devices) {
    return devices.error();
  }
  const Result<HostDeviceChoice> choice = chooseHostDevice(*devices, options.device);
  if (!choice) {
    return choice.error();
  }
  host->physicalDevice = choice->physicalDevice;
  host->info = choice->info;
  vkGetPhysicalDeviceMemoryProperties(host->physicalDevice, &state.memory);
  if (const Status status = host->createDevice(options); !status) {
    return status.error();
  }
  return host;
}

void Host::chooseFamilies(const HostOptions& options) {
  const VkQueueFlags graphics = options.useGraphics ? VK_QUEUE_GRAPHICS_BIT : 0;
  queueFamily = findQueueFamily(physicalDevice, VK_QUEUE_COMPUTE_BIT | graphics, 0, 0);
  computeQueue.family = uploadQueue.family = queueFamily;
  if (options.useOtherQueues) {
    computeQueue.family = findQueueFamily(physicalDevice, VK_QUEUE_COMPUTE_BIT, VK_QUEUE_GRAPHICS_BIT, queueFamily);
    uploadQueue.family = findQueueFamily(physicalDevice, VK_QUEUE_TRANSFER_BIT,
                                         VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT, queueFamily);
  }
}

Status Host::createDevice(const HostOptions& options) {
  State& state = *state_;
  state.features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  state.features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  state.features12.pNext = &state.features13;
  state.features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  state.features.pNext = &state.features12;
  const char* missing = nullptr;
  if (frothRequireFeatures(&state.features, &missing) != FROTH_OK) {
    return makeError(ErrorKind::kUnsupported, "froth needs features of %s, which this host does not know", missing);
  }
  VkPhysicalDeviceVulkan13Features offered13{};
  offered13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  VkPhysicalDeviceFeatures2 offered{};
  offered.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  offered.pNext = &offered13;
  vkGetPhysicalDeviceFeatures2(physicalDevice, &offered);
  state.features.features.shaderStorageImageExtendedFormats = offered.features.shaderStorageImageExtendedFormats;
  state.features13.dynamicRendering = offered13.dynamicRendering;

  state.usesGraphics = options.useGraphics;
  state.features12.timelineSemaphore = options.useOtherQueues;  // every device has them
  chooseFamilies(options);
  const float priority = 1.0f;
  std::vector<VkDeviceQueueCreateInfo> queueInfos;
  for (const uint32_t family : std::set<uint32_t>{queueFamily, computeQueue.family, uploadQueue.family}) {
    VkDeviceQueueCreateInfo& queueInfo = queueInfos.emplace_back();
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = family;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
  }
  VkDeviceCreateInfo deviceInfo{};
  deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  deviceInfo.pNext = &state.features;
  deviceInfo.queueCreateInfoCount = static_cast<uint32_t>(queueInfos.size());
  deviceInfo.pQueueCreateInfos = queueInfos.data();
  deviceInfo.enabledExtensionCount = static_cast<uint32_t>(options.deviceExtensions.size());
  deviceInfo.ppEnabledExtensionNames = options.deviceExtensions.data();
  if (const VkResult code = vkCreateDevice(physicalDevice, &deviceInfo, nullptr, &device); code != VK_SUCCESS) {
    return failed("vkCreateDevice", code);
  }
  vkGetDeviceQueue(device, queueFamily, 0, &queue);
  vkGetDeviceQueue(device, computeQueue.family, 0, &computeQueue.queue);
  vkGetDeviceQueue(device, uploadQueue.family, 0, &uploadQueue.queue);
  return createCommands();
}

Status Host::createCommands() {
  State& state = *state_;
  VkCommandPoolCreateInfo poolInfo{};
  poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  poolInfo.queueFamilyIndex = queueFamily;
  if (const VkResult code = vkCreateCommandPool(device, &poolInfo, nullptr, &state.pool); code != VK_SUCCESS) {
    return failed("vkCreateCommandPool", code);
  }
  VkCommandBufferAllocateInfo bufferInfo{};
  bufferInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  bufferInfo.commandPool = state.pool;
  bufferInfo.commandBufferCount = 1;
  if (const VkResult code = vkAllocateCommandBuffers(device, &bufferInfo, &state.commands); code != VK_SUCCESS) {
    return failed("vkAllocateCommandBuffers", code);
  }
  return {};
}

Host::~Host() {
  if (device) {
    vkDeviceWaitIdle(device);
    vkDestroyCommandPool(device, state_->pool, nullptr);
    vkDestroyDevice(device, nullptr);
  }
  if (state_->instance.instance) {
    destroyHostInstance(state_->instance);
  }
}

FrothContextInfo Host::contextInfo() const {
  FrothContextInfo context{};
  context.structSize = sizeof(context);
  context.abiVersion = FROTH_ABI_VERSION;
  context.getInstanceProcAddr = vkGetInstanceProcAddr;
  context.instance = instance;
  context.physicalDevice = physicalDevice;
  context.device = device;
  context.enabledFeatures = &state_->features;
  context.queueFamily = queueFamily;
  return context;
}

Status Host::submit(const std::function<Status(VkCommandBuffer, uint64_t serial)>& record) {
  const uint64_t serial = ++state_->serial;
  return state_->runCommands(device, queue, [&](VkCommandBuffer commands) { return record(commands, serial); });
}

uint64_t Host::nextSerial() const { return state_->serial + 1; }

Status Host::State::runCommands(VkDevice onDevice, VkQueue onQueue,
                                const std::function<Status(VkCommandBuffer)>& record) {
  VkCommandBufferBeginInfo beginInfo{};
  beginInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  beginInfo.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  if (const VkResult code = vkResetCommandPool(onDevice, pool, 0); code != VK_SUCCESS) {
    return failed("vkResetCommandPool", code);
  }
  if (const VkResult code = vkBeginCommandBuffer(commands, &beginInfo); code != VK_SUCCESS) {
    return failed("vkBeginCommandBuffer", code);
  }
  const Status status = record(commands);
  if (const VkResult code = vkEndCommandBuffer(commands); code != VK_SUCCESS) {
    return failed("vkEndCommandBuffer", code);
  }
  if (!status) {
    return status;
  }
  VkSubmitInfo submitInfo{};
  submitInfo.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submitInfo.commandBufferCount = 1;
  submitInfo.pCommandBuffers = &commands;
  if (const VkResult code = vkQueueSubmit(onQueue, 1, &submitInfo, VK_NULL_HANDLE); code != VK_SUCCESS) {
    return failed("vkQueueSubmit", code);
  }
  if (const VkResult code = vkQueueWaitIdle(onQueue); code != VK_SUCCESS) {
    return failed("vkQueueWaitIdle", code);
  }
  return {};
}

std::vector<std::string> Host::validationMessages() const {
  const std::lock_guard<std::mutex> lock(state_->log.mutex);
  return state_->log.messages;
}

void Host::forgetValidationMessages() {
  const std::lock_guard<std::mutex> lock(state_->log.mutex);
  state_->log.messages.clear();
}

Status Host::checkSilence() const {
  const std::vector<std::string> messages = validationMessages();
  if (messages.empty()) return {};
  return makeError(ErrorKind::kUnsupported, "%zu validation messages; the first: %s", messages.size(),
                   messages.front().c_str());
}

}  // namespace froth
