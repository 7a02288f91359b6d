// What frames cost a game while things change: 600 of them, 60 a second, in which two assets open, a second instance
// appears, the view is made anew for another size, the budget falls and rises. Prints the longest call on the frame's
// thread, by name, the ten longest of all, the longest frame on the GPU, and how many frames were not what the same
// frame shows once all is settled, and did not say so.
//   froth_bench_frame_trace FIRST.froth SECOND.froth [threads; 0: none, load within frothUpdate]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "froth/froth_pool.h"
#include "host/host.h"
#include "host/make_struct.h"
#include "tests/bench/bench_calls.h"

using namespace froth;

namespace {

constexpr uint32_t kFrames = 600;
constexpr VkExtent2D kSmall{960, 540}, kLarge{1280, 720};
constexpr std::chrono::microseconds kPeriod(16667);
constexpr double kSeen = 1.0 / 255;

constexpr size_t kListed = 10;

struct Longest {
  double milliseconds = 0;
  uint32_t frame = 0;
};

struct Call {
  double milliseconds;
  uint32_t frame;
  const char* name;
};

class Trace {
 public:
  Trace(Host& host, uint32_t threads) : host_(host) {
    FrothContextInfo info = host.contextInfo();
    info.onMessage = [](void*, FrothSeverity, FrothResult, const char* object, const char* text) {
      std::fprintf(stderr, "%s: %s\n", object, text);
    };
    if (threads > 0) {
      require(frothCreateJobPool(threads, &pool_) == FROTH_OK, "no pool");
      info.runJob = frothRunInPool;
      info.jobUser = pool_;
    }
    time("frothCreateContext", [&] { return frothCreateContext(&info, &context_); });
    resize(kSmall);
  }
  ~Trace() {
    frothDestroyContext(context_, UINT64_MAX);
    frothDestroyJobPool(pool_);
    host_.destroyImage(image_);
  }

  void open(const char* path) {
    auto info = makeStruct<FrothAssetInfo>();
    info.path = path;
    time("frothOpenAsset", [&] { return frothOpenAsset(context_, &info, &assets_.emplace_back()); });
    place(assets_.size() - 1);
  }

  void place(size_t asset) {
    auto info = makeStruct<FrothInstanceInfo>();
    info.asset = assets_[asset];
    info.position[0] = 0.5 * static_cast<double>(instanceCount_++);
    FrothInstance instance;
    time("frothCreateInstance", [&] { return frothCreateInstance(context_, &info, &instance); });
  }

  void resize(VkExtent2D extent) {
    auto info = makeStruct<FrothViewInfo>();
    info.maxExtent = extent;
    info.measurePasses = 1;
    info.startLike = view_;
    FrothView made{};
    time("frothCreateView", [&] { return frothCreateView(context_, &info, &made); });
    if (view_.generation != 0) time("frothDestroyView", [&] { return frothDestroyView(context_, view_); });
    view_ = made;
    host_.destroyImage(image_);
    image_ = *host_.createImage(VK_FORMAT_R16G16B16A16_SFLOAT, extent);
  }

  void setBudget(uint64_t bytes) {
    time("frothSetBudget", [&] { return frothSetBudget(context_, bytes); });
  }

  FrothMemoryReport memory() {
    auto report = makeStruct<FrothMemoryReport>();
    frothGetMemoryReport(context_, &report);
    return report;
  }

  FrothResult draw(const FrothCamera& camera) {
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = camera;
    info.colour = host_.describe(image_);
    info.nearRatio = info.nearDepth = FROTH_NEAR_DEFAULT;
    info.cutoff = 0.01f;
    FrothResult drawn = FROTH_OK;
    const Status status = host_.submit([&](VkCommandBuffer commands, uint64_t serial) {
      auto begun = makeStruct<FrothFrame>();
      begun.serial = serial;
      begun.completedSerial = serial - 1;
      begun.uploadBytes = 8u << 20;
      time("frothUpdate", [&] { return frothUpdate(context_, &begun, nullptr); });
      time("frothRecordUpload", [&] { return frothRecordUpload(context_, commands); });
      time("frothRecordRaster", [&] { return drawn = frothRecordRaster(context_, view_, commands, &info); });
      return Status();
    });
    require(bool(status), status ? "" : status.error().message.c_str());
    return drawn;
  }

  std::vector<float> pixels() { return *host_.readImage(image_); }

  void readGpuTime() {
    auto status = makeStruct<FrothViewStatus>();
    frothGetViewStatus(context_, view_, &status);
    double sum = 0;
    for (uint32_t i = 0; i < status.passCount; ++i) sum += status.passes[i].milliseconds;
    if (sum > gpu.milliseconds) gpu = {sum, frame};
  }

  uint32_t statusBits() {  // of the frame before the last
    auto status = makeStruct<FrothViewStatus>();
    frothGetViewStatus(context_, view_, &status);
    return status.bits;
  }

  bool isSettled() {
    auto info = makeStruct<FrothAssetStatus>();
    return std::all_of(assets_.begin(), assets_.end(), [&](FrothAsset asset) {
      return frothGetAssetStatus(context_, asset, &info) == FROTH_OK && info.state == FROTH_ASSET_READY;
    });
  }

  // Within the first asset, as far as its bounds are known.
  FrothCamera cameraAt(double angle) {
    auto status = makeStruct<FrothAssetStatus>();
    frothGetAssetStatus(context_, assets_.front(), &status);
    double middle[3], size = 0;
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis] = 0.5 * (double{status.boundsMin[axis]} + status.boundsMax[axis]);
      size = std::max(size, double{status.boundsMax[axis]} - status.boundsMin[axis]);
    }
    const double c = std::cos(angle), s = std::sin(angle);
    FrothCamera camera{};
    const double away = 0.4 * size;
    camera.eye[0] = middle[0] - s * away;
    camera.eye[1] = middle[1];
    camera.eye[2] = middle[2] - c * away;
    const double rows[3][3] = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) camera.viewFromWorld[3 * column + row] = static_cast<float>(rows[row][column]);
    }
    camera.clipFromView[0] = static_cast<float>(image_.extent.height) / static_cast<float>(image_.extent.width);
    camera.clipFromView[5] = 1;
    camera.clipFromView[11] = 1;
    camera.clipFromView[14] = 0.01f;
    camera.viewport = {0, 0, static_cast<float>(image_.extent.width), static_cast<float>(image_.extent.height), 0, 1};
    return camera;
  }

  std::map<std::string, Longest> calls;
  std::vector<Call> allCalls;
  Longest gpu;
  uint32_t frame = 0;

 private:
  template <class Call>
  void time(const char* name, const Call& call) {
    const auto begin = std::chrono::steady_clock::now();
    const FrothResult result = call();
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    require(result >= 0, name);
    Longest& longest = calls[name];
    if (taken.count() > longest.milliseconds) longest = {taken.count(), frame};
    allCalls.push_back({taken.count(), frame, name});
  }

  Host& host_;
  FrothJobPool* pool_ = nullptr;
  FrothContext* context_ = nullptr;
  FrothView view_{};
  HostImage image_;
  std::vector<FrothAsset> assets_;
  uint32_t instanceCount_ = 0;
};

double largestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(double{a[i]} - b[i]));
  return largest;
}

}  // namespace

int main(int argc, char** argv) {
  require(argc >= 3, "give two assets");
  const uint32_t threads = argc > 3 ? static_cast<uint32_t>(std::atoi(argv[3])) : 2;
  Result<std::unique_ptr<Host>> host = Host::create({.device = ""});
  require(bool(host), "no device");
  Trace trace(**host, threads);
  uint32_t incomplete = 0, wrong = 0, checked = 0;
  auto next = std::chrono::steady_clock::now();
  for (trace.frame = 1; trace.frame <= kFrames; ++trace.frame) {
    const uint32_t frame = trace.frame;
    std::this_thread::sleep_until(next += kPeriod);
    if (frame == 1) trace.open(argv[1]);
    if (frame == 150) trace.open(argv[2]);
    if (frame == 250) trace.place(0);
    if (frame == 350) trace.resize(kLarge);
    if (frame == 450) trace.setBudget(trace.memory().deviceBytes * 3 / 4);
    if (frame == 520) trace.setBudget(0);
    const FrothCamera camera = trace.cameraAt(0.002 * frame);
    const FrothResult drawn = trace.draw(camera);
    trace.readGpuTime();
    incomplete += drawn == FROTH_INCOMPLETE;
    // Around every event: is what the call said to be whole the same a frame later?
    const bool isNearEvent = frame < 60 || (frame >= 150 && frame < 200) || (frame >= 250 && frame < 270) ||
                             (frame >= 350 && frame < 360) || (frame >= 450 && frame < 470) || frame >= 590;
    if (drawn != FROTH_OK || !isNearEvent) continue;
    const std::vector<float> shown = trace.pixels();
    trace.draw(camera);
    const uint32_t bits = trace.statusBits();
    if (trace.draw(camera) != FROTH_OK) continue;  // an asset became READY meanwhile
    ++checked;
    const double difference = largestDifference(shown, trace.pixels());
    if (difference <= kSeen) continue;
    ++wrong;
    std::printf("  frame %u was not whole: off by %.1f of 255, bits %u\n", frame, 255 * difference, bits);
  }
  std::printf("%s, %u threads\n", (*host)->info.name.c_str(), threads);
  for (const auto& [name, longest] : trace.calls) {
    std::printf("  %-22s longest %8.3f ms, in frame %u\n", name.c_str(), longest.milliseconds, longest.frame);
  }
  std::ranges::sort(trace.allCalls, std::greater(), &Call::milliseconds);
  for (size_t i = 0; i < std::min(kListed, trace.allCalls.size()); ++i) {
    const Call& call = trace.allCalls[i];
    std::printf("  %8.3f ms in frame %3u: %s\n", call.milliseconds, call.frame, call.name);
  }
  std::printf("  GPU                    longest %8.3f ms, in frame %u\n", trace.gpu.milliseconds, trace.gpu.frame);
  std::printf("  %u frames INCOMPLETE; %u said to be whole were drawn again, %u of them differ by more than 1/255%s\n",
              incomplete, checked, wrong, trace.isSettled() ? "" : "; NOT SETTLED");
  return wrong == 0 ? 0 : 1;
}
