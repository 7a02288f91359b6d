#include "host/gpu_timer.h"

#include "host/vulkan_check.h"

namespace froth {

Result<std::unique_ptr<GpuTimer>> GpuTimer::create(const Host& host) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(host.physicalDevice, &properties);
  std::unique_ptr<GpuTimer> timer(new GpuTimer(host.device, properties.limits.timestampPeriod * 1e-6));
  for (Slot& slot : timer->slots_) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = kMostPasses + 1;
    const Status made = checkVulkan(vkCreateQueryPool(host.device, &info, nullptr, &slot.queries), "vkCreateQueryPool");
    if (!made) return made.error();
  }
  return timer;
}

GpuTimer::~GpuTimer() {
  for (const Slot& slot : slots_) vkDestroyQueryPool(device_, slot.queries, nullptr);
}

void GpuTimer::begin(VkCommandBuffer commands, uint64_t serial) {
  current_ = &slots_[serial % kFramesInFlight];
  current_->serial = serial;
  current_->names.clear();
  vkCmdResetQueryPool(commands, current_->queries, 0, kMostPasses + 1);
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, current_->queries, 0);
}

void GpuTimer::mark(VkCommandBuffer commands, const char* name) {
  current_->names.push_back(name);
  const auto query = static_cast<uint32_t>(current_->names.size());
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, current_->queries, query);
}

GpuTimer::Times GpuTimer::read(uint64_t completedSerial) const {
  const Slot* newest = nullptr;
  for (const Slot& slot : slots_) {
    const bool isComplete = !slot.names.empty() && slot.serial <= completedSerial;
    if (isComplete && (!newest || slot.serial > newest->serial)) newest = &slot;
  }
  if (!newest) return {};
  uint64_t ticks[kMostPasses + 1] = {};
  const auto count = static_cast<uint32_t>(newest->names.size()) + 1;
  const VkResult got = vkGetQueryPoolResults(device_, newest->queries, 0, count, sizeof(ticks), ticks, sizeof(ticks[0]),
                                             VK_QUERY_RESULT_64_BIT);
  if (got != VK_SUCCESS) return {};
  Times times{newest->serial, {}};
  for (uint32_t pass = 0; pass + 1 < count; ++pass) {
    times.passes.push_back(
        {newest->names[pass], static_cast<double>(ticks[pass + 1] - ticks[pass]) * millisecondsPerTick_});
  }
  return times;
}

}  // namespace froth
