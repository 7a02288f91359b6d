// GPU time of rays that are cast from a buffer (frothRecordRays), between timestamps around the call.
#include <cstring>

#include "froth/froth_walk.h"
#include "host/make_struct.h"
#include "measure/gpu/gpu_renderer_state.h"

namespace froth {
namespace {

// Of two timestamps.
class RayTimer {
 public:
  explicit RayTimer(const Host& host) : device_(host.device) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2;
    vkCreateQueryPool(device_, &info, nullptr, &pool_);
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(host.physicalDevice, &properties);
    period_ = double{properties.limits.timestampPeriod};
  }
  ~RayTimer() { vkDestroyQueryPool(device_, pool_, nullptr); }
  RayTimer(const RayTimer&) = delete;
  RayTimer& operator=(const RayTimer&) = delete;

  bool isMade() const { return pool_ != VK_NULL_HANDLE; }
  void reset(VkCommandBuffer commands) const { vkCmdResetQueryPool(commands, pool_, 0, 2); }
  void write(VkCommandBuffer commands, uint32_t query) const {
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, query);
  }
  double milliseconds() const {
    uint64_t times[2]{};
    vkGetQueryPoolResults(device_, pool_, 0, 2, sizeof(times), times, sizeof(uint64_t),
                          VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    return 1e-6 * static_cast<double>(times[1] - times[0]) * period_;
  }

 private:
  VkDevice device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  double period_ = 0;
};

}  // namespace

Result<RayTimes> GpuRenderer::timeRays(const std::vector<FrothGpuRay>& rays, const RayTiming& timing) {
  RayTimes result;
  if (rays.empty()) return result;
  State& state = *state_;
  const size_t raysSize = rays.size() * sizeof(FrothGpuRay), hitsSize = rays.size() * sizeof(FrothGpuHit);
  const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  const RayTimer timer(*state.host);
  if (!timer.isMade()) {
    return makeError(ErrorKind::kUnsupported, "device %s gives no timestamps", device().name.c_str());
  }
  Result<HostBuffer> buffer = state.host->createBuffer(raysSize + hitsSize, usage);
  if (!buffer) return buffer.error();
  std::memcpy(buffer->mapped, rays.data(), raysSize);
  const auto count = static_cast<uint32_t>(rays.size());
  auto info = makeStruct<FrothWalkInfo>();
  for (int axis = 0; axis < 3; ++axis) info.eye[axis] = timing.eye[axis];
  info.cutoff = timing.cutoff > 0 ? timing.cutoff : -1.0f;
  const auto record = [&](VkCommandBuffer commands) -> Status {
    VkDescriptorSet set = VK_NULL_HANDLE;
    FrothResult done = frothRecordWalkSet(state.context, commands, &info, &set);
    if (Status made = state.check(done, "frothRecordWalkSet"); !made) return made;
    timer.reset(commands);
    timer.write(commands, 0);
    done = frothRecordRays(state.context, commands, buffer->address, buffer->address + raysSize, count, timing.kind);
    timer.write(commands, 1);
    recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                        VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    return state.check(done, "frothRecordRays");
  };
  Status done;
  for (uint32_t frame = 0; done && frame < timing.frames; ++frame) {
    done = state.submitFrame(record);
    if (done) result.milliseconds.push_back(timer.milliseconds());
  }
  if (done && timing.readsHits) {
    result.hits.resize(rays.size());
    std::memcpy(result.hits.data(), static_cast<const char*>(buffer->mapped) + raysSize, hitsSize);
  }
  state.host->destroyBuffer(*buffer);
  // The counts of a frame are known in the frothUpdate after it.
  if (done) done = state.submitFrame();
  if (!done) return done.error();
  result.status = makeStruct<FrothWalkStatus>();
  done = state.check(frothGetWalkStatus(state.context, &result.status), "frothGetWalkStatus");
  if (!done) return done.error();
  return result;
}

}  // namespace froth
