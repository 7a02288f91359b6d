// froth_bench_rays ASSET CAMERAS [options]: milliseconds of frothRecordRays, and what the rays cost.
//
// The camera's rays, what a mirror in place of every surface they meet would show, and the shadow of one light on these
// surfaces.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "froth/froth_walk.h"
#include "host/host.h"
#include "host/make_struct.h"
#include "reference/camera/camera.h"
#include "runtime/device/device.h"
#include "tests/bench/bench_calls.h"

namespace froth {
namespace {

struct Options {
  std::string asset, cameras, device;
  uint32_t view = 0, width = 1920, height = 1080, frames = 20, layers = 0;
  float cutoff = 0;
};

class RayBench {
 public:
  explicit RayBench(const Options& options);
  ~RayBench();

  std::vector<FrothGpuRay> cameraRays() const;
  // Casts them again and again, prints the least and the median time.
  std::vector<FrothGpuHit> measure(const char* name, const std::vector<FrothGpuRay>& rays, FrothRayKind kind);

 private:
  FrothContext* createContext(bool countsWork);
  void open(FrothContext* context);
  double cast(FrothContext* context, uint32_t count, FrothRayKind kind);
  template <class Record>
  void frame(FrothContext* context, Record record);

  const Options& options_;
  View view_;
  std::unique_ptr<Host> host_;
  Device device_;
  FrothContext* timed_ = nullptr;
  FrothContext* counted_ = nullptr;
  GpuBuffer rays_, hits_, staging_, readback_;
  VkQueryPool queries_ = VK_NULL_HANDLE;
};

RayBench::RayBench(const Options& options) : options_(options) {
  const CameraSet cameras = take(readCameras(options.cameras));
  view_ = resizeView(cameras.views.at(options.view), options.width, options.height);
  host_ = take(Host::create({.device = options.device}));
  device_ = take(Device::create(vkGetInstanceProcAddr, host_->instance, host_->physicalDevice, host_->device));
  timed_ = createContext(false);
  counted_ = createContext(true);
  const VkDeviceSize pixels = VkDeviceSize{view_.width} * view_.height;
  const auto make = [&](BufferKind kind, VkDeviceSize size) {
    const MemoryUse use = kind == BufferKind::kDevice ? MemoryUse::kViews : MemoryUse::kViewsHost;
    return take(device_.createBuffer(use, kind, size, "rays"));
  };
  rays_ = make(BufferKind::kDevice, pixels * sizeof(FrothGpuRay));
  hits_ = make(BufferKind::kDevice, pixels * sizeof(FrothGpuHit));
  staging_ = make(BufferKind::kStaging, rays_.size);
  readback_ = make(BufferKind::kReadback, hits_.size);
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2;
  vkCreateQueryPool(host_->device, &info, nullptr, &queries_);
}

RayBench::~RayBench() {
  vkDestroyQueryPool(host_->device, queries_, nullptr);
  for (GpuBuffer* buffer : {&rays_, &hits_, &staging_, &readback_}) device_.destroyBuffer(*buffer);
  for (FrothContext* context : {timed_, counted_}) frothDestroyContext(context, UINT64_MAX);
}

FrothContext* RayBench::createContext(bool countsWork) {
  FrothContextInfo info = host_->contextInfo();
  info.walkShaders = 1;
  info.countWork = countsWork;
  info.onMessage = [](void*, FrothSeverity, FrothResult, const char* object, const char* text) {
    fmt::print(stderr, "{}: {}\n", object, text);
  };
  FrothContext* context = nullptr;
  check(frothCreateContext(&info, &context), "frothCreateContext");
  open(context);
  return context;
}

template <class Record>
void RayBench::frame(FrothContext* context, Record record) {
  const Status submitted = host_->submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = serial;
    frame.completedSerial = serial - 1;
    check(frothUpdate(context, &frame, nullptr), "frothUpdate");
    check(frothRecordUpload(context, commands), "frothRecordUpload");
    record(commands);
    return {};
  });
  check(submitted);
}

void RayBench::open(FrothContext* context) {
  auto info = makeStruct<FrothAssetInfo>();
  info.path = options_.asset.c_str();
  info.layers = options_.layers;
  auto instanceInfo = makeStruct<FrothInstanceInfo>();
  check(frothOpenAsset(context, &info, &instanceInfo.asset), "frothOpenAsset");
  auto status = makeStruct<FrothAssetStatus>();
  do {
    frame(context, [](VkCommandBuffer) {});
    check(frothGetAssetStatus(context, instanceInfo.asset, &status), "frothGetAssetStatus");
  } while (status.state == FROTH_ASSET_OPENING);
  FrothInstance instance{};
  check(frothCreateInstance(context, &instanceInfo, &instance), "frothCreateInstance");
  fmt::print("{} on {}: {} cells, {:.1f} MB, {}x{}\n", options_.asset, host_->info.name, status.cellCount,
             1e-6 * static_cast<double>(status.deviceBytes), view_.width, view_.height);
}

// Block by block, as a compute shader casts them.
std::vector<FrothGpuRay> RayBench::cameraRays() const {
  constexpr uint32_t kBlock = 8;
  const uint32_t blocksX = view_.width / kBlock, blocksY = view_.height / kBlock;
  std::vector<FrothGpuRay> rays;
  for (uint32_t i = 0; i < blocksX * blocksY * kBlock * kBlock; ++i) {
    const uint32_t block = i / (kBlock * kBlock), x = block % blocksX * kBlock + i % kBlock,
                   y = block / blocksX * kBlock + i / kBlock % kBlock;
    const double local[3] = {(x + 0.5 - view_.cx) / view_.fx, (y + 0.5 - view_.cy) / view_.fy, 1};
    FrothGpuRay ray{};
    for (int row = 0; row < 3; ++row) {
      const double* axes = &view_.worldFromCamera[4 * row];
      ray.direction[row] = static_cast<float>(axes[0] * local[0] + axes[1] * local[1] + axes[2] * local[2]);
    }
    rays.push_back(ray);
  }
  return rays;
}

double RayBench::cast(FrothContext* context, uint32_t count, FrothRayKind kind) {
  auto info = makeStruct<FrothWalkInfo>();
  for (int axis = 0; axis < 3; ++axis) info.eye[axis] = view_.worldFromCamera[4 * axis + 3];
  info.cutoff = options_.cutoff;
  frame(context, [&](VkCommandBuffer commands) {
    VkDescriptorSet set = VK_NULL_HANDLE;
    check(frothRecordWalkSet(context, commands, &info, &set), "frothRecordWalkSet");
    vkCmdResetQueryPool(commands, queries_, 0, 2);
    const VkBufferCopy in{0, 0, rays_.size}, out{0, 0, hits_.size};
    vkCmdCopyBuffer(commands, staging_.buffer, rays_.buffer, 1, &in);
    device_.table.recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, 0);
    require(frothRecordRays(context, commands, rays_.address, hits_.address, count, kind) == FROTH_OK,
            "frothRecordRays");
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, 1);
    device_.table.recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                      VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
                                      VK_ACCESS_2_TRANSFER_READ_BIT);
    vkCmdCopyBuffer(commands, hits_.buffer, readback_.buffer, 1, &out);
  });
  uint64_t times[2];
  vkGetQueryPoolResults(host_->device, queries_, 0, 2, sizeof(times), times, sizeof(uint64_t),
                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
  return 1e-6 * static_cast<double>(times[1] - times[0]) * double{device_.properties.limits.timestampPeriod};
}

std::vector<FrothGpuHit> RayBench::measure(const char* name, const std::vector<FrothGpuRay>& rays, FrothRayKind kind) {
  const auto count = static_cast<uint32_t>(rays.size());
  std::memcpy(staging_.mapped, rays.data(), rays.size() * sizeof(FrothGpuRay));
  std::vector<double> times(options_.frames);
  for (double& time : times) time = cast(timed_, count, kind);
  std::sort(times.begin(), times.end());
  cast(counted_, count, kind);
  frame(counted_, [](VkCommandBuffer) {});
  auto status = makeStruct<FrothWalkStatus>();
  check(frothGetWalkStatus(counted_, &status), "frothGetWalkStatus");
  const auto per = [&](uint64_t number) { return static_cast<double>(number) / static_cast<double>(count); };
  fmt::print(
      "{:<22} {:8.3f} ms (least {:.3f}), {} rays; per ray: {:.2f} descents, {:.2f} cells, {:.1f} neighbours, {:.2f} "
      "met, "
      "{:.2f} detail sites\n",
      name, times[times.size() / 2], times.front(), count, per(status.descents), per(status.cells),
      per(status.neighbours), per(status.cellsMet), per(status.detailSites));
  std::vector<FrothGpuHit> hits(rays.size());
  std::memcpy(hits.data(), readback_.mapped, hits.size() * sizeof(FrothGpuHit));
  return hits;
}

// From where the rays were stopped, a hair above the surface. light: null for the mirrored direction.
std::vector<FrothGpuRay> secondRays(const std::vector<FrothGpuRay>& rays, const std::vector<FrothGpuHit>& hits,
                                    const float* light) {
  std::vector<FrothGpuRay> second;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!std::isfinite(hits[i].distance)) continue;
    const float* d = rays[i].direction;
    const float* n = hits[i].normal;
    const float length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const float facing = (d[0] * n[0] + d[1] * n[1] + d[2] * n[2]) / length;
    const float side = facing < 0 ? 1.0f : -1.0f;
    FrothGpuRay ray{};
    for (int axis = 0; axis < 3; ++axis) {
      const float along = d[axis] / length;
      ray.origin[axis] = hits[i].distance * (along + side * 0.01f * n[axis]);
      ray.direction[axis] = light ? light[axis] : along - 2 * facing * n[axis];
    }
    ray.apex = light ? 0 : hits[i].distance;
    second.push_back(ray);
  }
  return second;
}

void run(const Options& options) {
  RayBench bench(options);
  const std::vector<FrothGpuRay> rays = bench.cameraRays();
  bench.measure("camera, transmittance", rays, FROTH_RAY_TRANSMITTANCE);
  bench.measure("camera, radiance", rays, FROTH_RAY_RADIANCE);
  const std::vector<FrothGpuHit> hits = bench.measure("camera, closest", rays, FROTH_RAY_CLOSEST);
  const float light[3] = {0.3f, -0.8f, 0.5f};
  bench.measure("mirror, radiance", secondRays(rays, hits, nullptr), FROTH_RAY_RADIANCE);
  bench.measure("shadow, transmittance", secondRays(rays, hits, light), FROTH_RAY_TRANSMITTANCE);
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::Options options;
  CLI::App program("Times rays of froth_walk.h");
  program.add_option("ASSET", options.asset)->required();
  program.add_option("CAMERAS", options.cameras)->required();
  program.add_option("--view", options.view);
  program.add_option("--width", options.width);
  program.add_option("--height", options.height);
  program.add_option("--frames", options.frames);
  program.add_option("--layers", options.layers);
  program.add_option("--cutoff", options.cutoff);
  program.add_option("--device", options.device);
  CLI11_PARSE(program, argc, argv);
  try {
    froth::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
