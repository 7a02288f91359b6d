#include "runtime/render/pass_timer.h"

#include <algorithm>
#include <iterator>

namespace froth {
namespace {

// Of a counter of so many bits [1..64] that wraps.
uint64_t ticksBetween(uint64_t begin, uint64_t end, uint32_t bits) {
  return (end - begin) & (~uint64_t{0} >> (64 - bits));
}

}  // namespace

Result<std::unique_ptr<PassTimer>> PassTimer::create(Device& device, uint32_t recordings) {
  std::unique_ptr<PassTimer> timer(new PassTimer(device));
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = recordings * kQueries;
  const Result<VkQueryPool> pool =
      device.create(VK_OBJECT_TYPE_QUERY_POOL, "timestamps of a view", device.table.vkCreateQueryPool, info);
  if (!pool) return pool.error();
  timer->pool_ = *pool;
  timer->names_.resize(recordings);
  for (auto& names : timer->names_) names.reserve(kMaxPasses);
  return timer;
}

PassTimer::~PassTimer() { device_.table.vkDestroyQueryPool(device_.device, pool_, nullptr); }

void PassTimer::stamp(VkCommandBuffer commandBuffer, uint32_t query) {
  device_.table.vkCmdWriteTimestamp2(commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, query);
}

void PassTimer::begin(VkCommandBuffer commandBuffer, uint32_t recording) {
  names_[recording].clear();
  device_.table.vkCmdResetQueryPool(commandBuffer, pool_, recording * kQueries, kQueries);
  stamp(commandBuffer, recording * kQueries);
}

void PassTimer::mark(VkCommandBuffer commandBuffer, uint32_t recording, const char* name) {
  names_[recording].push_back(name);
  stamp(commandBuffer, recording * kQueries + static_cast<uint32_t>(names_[recording].size()));
}

void PassTimer::read(uint32_t recording, FrothViewStatus& status) const {
  const auto passes = static_cast<uint32_t>(names_[recording].size());
  if (passes == 0) return;
  std::array<uint64_t, kQueries> stamps{};
  const VkResult result =
      device_.table.vkGetQueryPoolResults(device_.device, pool_, recording * kQueries, passes + 1, sizeof(stamps),
                                          stamps.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT);
  if (result == VK_ERROR_DEVICE_LOST) {
    (void)device_.explain(result, "vkGetQueryPoolResults");  // frothUpdate tells
  }
  if (result != VK_SUCCESS) return;
  const double millisecondsPerTick = device_.properties.limits.timestampPeriod * 1e-6;
  for (uint32_t i = 0; i < passes && status.passCount < std::size(status.passes); ++i) {
    status.passes[status.passCount++] = {
        names_[recording][i],
        static_cast<double>(ticksBetween(stamps[i], stamps[i + 1], device_.timestampBits)) * millisecondsPerTick};
  }
}

}  // namespace froth
