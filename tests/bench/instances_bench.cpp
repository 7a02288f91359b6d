// froth_bench_instances ASSET [WIDTH HEIGHT FRAMES]: what several instances of an asset in one view cost, by pass, on
// the GPU.
//
// Seen from the stored start view: one alone; two and four beside each other, moved by 0.6 of the box's width; two and
// four behind each other, whose boxes do not meet; two and four crossing, turned about the point in the middle of the
// picture. Milliseconds, median over FRAMES.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/percentiles.h"
#include "froth/froth_query.h"
#include "host/host.h"
#include "host/make_struct.h"
#include "tests/bench/bench_calls.h"

using namespace froth;

namespace {

void printMessage(void*, FrothSeverity, FrothResult, const char* object, const char* text) {
  std::fprintf(stderr, "%s: %s\n", object, text);
}

FrothCamera cameraOf(const FrothStoredCamera& stored, VkExtent2D extent) {
  FrothCamera camera{};
  for (int axis = 0; axis < 3; ++axis) {
    camera.eye[axis] = stored.worldFromCamera[4 * axis + 3];
    for (int row = 0; row < 3; ++row) {
      camera.viewFromWorld[3 * axis + row] = static_cast<float>(stored.worldFromCamera[4 * axis + row]);
    }
  }
  const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
  camera.clipFromView[5] = static_cast<float>(1 / stored.tanHalfFovY);
  camera.clipFromView[0] = camera.clipFromView[5] * height / width;
  camera.clipFromView[11] = 1;
  camera.clipFromView[14] = 0.01f;
  camera.viewport = {0, 0, width, height, 0, 1};
  return camera;
}

class Bench {
 public:
  Bench(const char* path, VkExtent2D extent) : host_(std::move(*Host::create({}))), extent_(extent) {
    FrothContextInfo contextInfo = host_->contextInfo();
    contextInfo.onMessage = printMessage;
    require(frothCreateContext(&contextInfo, &context_) == FROTH_OK, "frothCreateContext");
    auto assetInfo = makeStruct<FrothAssetInfo>();
    assetInfo.path = path;
    assetInfo.keepForQueries = 1;
    require(frothOpenAsset(context_, &assetInfo, &asset_) == FROTH_OK, "frothOpenAsset");
    do {
      runFrame(nullptr);
      require(frothGetAssetStatus(context_, asset_, &status_) == FROTH_OK && status_.state != FROTH_ASSET_FAILED, path);
    } while (status_.state == FROTH_ASSET_OPENING);
    require(status_.hasStartView, "the asset has no start view; bake it with --cameras");
    findMiddle();
    image_ = *host_->createImage(VK_FORMAT_R16G16B16A16_SFLOAT, extent);
    auto viewInfo = makeStruct<FrothViewInfo>();
    viewInfo.maxExtent = extent;
    viewInfo.measurePasses = 1;
    require(frothCreateView(context_, &viewInfo, &view_) == FROTH_OK, "frothCreateView");
    std::printf("%s, %u cells, %u x %u\n", host_->info.name.c_str(), status_.cellCount, extent.width, extent.height);
  }

  // angle [radians] between instances about the middle of the box; step: how far they are moved, in widths of the box;
  // behind: how far away from the camera, in lengths of the box along the axis on which it looks most.
  void measure(const char* name, int count, double angle, double step, double behind, int frames) {
    const int deepest = deepestAxis();
    const double forward = status_.startView.worldFromCamera[4 * deepest + 2] < 0 ? -behind : behind;
    std::vector<FrothInstance> instances;
    for (int i = 0; i < count; ++i) {
      auto info = makeStruct<FrothInstanceInfo>();
      info.asset = asset_;
      const double half = 0.5 * angle * i, firstPlace = 0.5 * (count - 1);
      info.rotation[1] = static_cast<float>(std::sin(half));
      info.rotation[3] = static_cast<float>(std::cos(half));
      const double c = std::cos(2 * half), s = std::sin(2 * half);
      const double x = middle_.position[0], z = middle_.position[2];
      info.position[0] = x - (c * x + s * z) + step * (i - firstPlace) * (status_.boundsMax[0] - status_.boundsMin[0]);
      info.position[2] = z - (-s * x + c * z);
      info.position[deepest] += forward * i * (status_.boundsMax[deepest] - status_.boundsMin[deepest]);
      instances.emplace_back();
      require(frothCreateInstance(context_, &info, &instances.back()) == FROTH_OK, "frothCreateInstance");
    }
    for (const bool isRaster : {true, false}) draw(name, isRaster, frames);
    for (const FrothInstance instance : instances) frothDestroyInstance(context_, instance);
    runFrame(nullptr);
  }

 private:
  int deepestAxis() const {
    const auto along = [&](int axis) { return std::abs(status_.startView.worldFromCamera[4 * axis + 2]); };
    return along(0) > std::max(along(1), along(2)) ? 0 : along(1) > along(2) ? 1 : 2;
  }

  // What the stored camera looks at.
  void findMiddle() {
    auto instanceInfo = makeStruct<FrothInstanceInfo>();
    instanceInfo.asset = asset_;
    FrothInstance instance{};
    require(frothCreateInstance(context_, &instanceInfo, &instance) == FROTH_OK, "frothCreateInstance");
    FrothRay ray{};
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = status_.startView.worldFromCamera[4 * axis + 3];
      ray.direction[axis] = status_.startView.worldFromCamera[4 * axis + 2];
    }
    require(frothCastRays(context_, nullptr, &ray, &middle_, 1) == FROTH_OK, "frothCastRays");
    frothDestroyInstance(context_, instance);
  }

  void runFrame(const FrothRenderInfo* info, bool isRaster = true) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = host_->nextSerial();
    frame.completedSerial = frame.serial - 1;
    require(frothUpdate(context_, &frame, nullptr) == FROTH_OK, "frothUpdate");
    const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t) -> Status {
      require(frothRecordUpload(context_, commands) == FROTH_OK, "frothRecordUpload");
      if (info) {
        require((isRaster ? frothRecordRaster : frothRecordWalk)(context_, view_, commands, info) == FROTH_OK, "draw");
      }
      return {};
    });
    require(bool(status), "submit");
  }

  void draw(const char* name, bool isRaster, int frames) {
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = cameraOf(status_.startView, extent_);
    info.nearRatio = info.nearDepth = FROTH_NEAR_DEFAULT;
    info.cutoff = 1e-2f;
    info.colour = host_->describe(image_);
    for (int i = 0; i < 10; ++i) runFrame(&info, isRaster);
    std::map<std::string, std::vector<double>> times;
    auto status = makeStruct<FrothViewStatus>();
    for (int i = 0; i < frames; ++i) {
      runFrame(&info, isRaster);
      require(frothGetViewStatus(context_, view_, &status) == FROTH_OK, "frothGetViewStatus");
      double total = 0;
      for (uint32_t pass = 0; pass < status.passCount; ++pass) {
        times[status.passes[pass].name].push_back(status.passes[pass].milliseconds);
        total += status.passes[pass].milliseconds;
      }
      times["total"].push_back(total);
    }
    std::printf("%-12s %-6s %8u cells ", name, isRaster ? "raster" : "walk", status.visibleCells);
    for (const auto& [pass, values] : times) std::printf(" %s %.4f", pass.c_str(), percentilesOf(values).median);
    std::printf("  bits %u\n", status.bits);
  }

  std::unique_ptr<Host> host_;
  VkExtent2D extent_;
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  FrothAssetStatus status_ = makeStruct<FrothAssetStatus>();
  FrothRayHit middle_{};
  FrothView view_{};
  HostImage image_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 5) {
    std::fprintf(stderr, "froth_bench_instances ASSET [WIDTH HEIGHT FRAMES]\n");
    return 2;
  }
  const auto numberAt = [&](int place, int otherwise) { return argc == 5 ? std::atoi(argv[place]) : otherwise; };
  const VkExtent2D extent{static_cast<uint32_t>(numberAt(2, 1920)), static_cast<uint32_t>(numberAt(3, 1080))};
  const int frames = numberAt(4, 100);
  Bench bench(argv[1], extent);
  bench.measure("one", 1, 0, 0, 0, frames);
  bench.measure("two beside", 2, 0, 0.6, 0, frames);
  bench.measure("four beside", 4, 0, 0.6, 0, frames);
  bench.measure("two behind", 2, 0, 0, 1.02, frames);
  bench.measure("four behind", 4, 0, 0, 1.02, frames);
  bench.measure("two across", 2, 1.2, 0, 0, frames);
  bench.measure("four across", 4, 0.7, 0, 0, frames);
}
