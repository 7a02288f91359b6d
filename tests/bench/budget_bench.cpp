// froth_bench_budget ASSET CAMERAS [options]: how a picture degrades when the device budget falls.
//
// Draws one view with all the memory that it wants, finds the least with which nothing is missing, and then gives the
// view parts of that. For each: its memory, the cells shown, and the PSNR against the whole picture.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "froth/froth.h"
#include "host/host.h"
#include "host/make_struct.h"
#include "measure/gpu/gpu_camera.h"
#include "reference/image/metrics.h"
#include "tests/bench/bench_calls.h"

namespace froth {
namespace {

constexpr double kParts[] = {1, 0.75, 0.5, 0.35, 0.25, 0.15};
constexpr int kSearchSteps = 8;  // to a 256th of the view's memory

struct Options {
  std::string asset, cameras, device;
  uint32_t view = 0, width = 330, height = 247;
  bool walks = false;
};

class BudgetBench {
 public:
  explicit BudgetBench(const Options& options);
  ~BudgetBench();

  void run();

 private:
  struct Drawn {
    Image colour;
    FrothViewStatus status;
  };

  void frame();
  // viewBytes: that the view may hold; 0: all it wants.
  Drawn draw(uint64_t viewBytes);
  void waitForAsset();

  Options options_;
  View view_;
  std::unique_ptr<Host> host_;
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  FrothInstance instance_{};
  FrothView froth_{};
  HostImage image_{};
  bool isReady_ = false;
  uint64_t heldBytes_ = 0, otherBytes_ = 0;
};

BudgetBench::BudgetBench(const Options& options) : options_(options) {
  const CameraSet cameras = take(readCameras(options.cameras));
  view_ = resizeView(cameras.views.at(options.view), options.width, options.height);
  host_ = take(Host::create({.device = options.device}));
  FrothContextInfo contextInfo = host_->contextInfo();
  contextInfo.lensClasses = lensClassesOf(view_);
  check(frothCreateContext(&contextInfo, &context_), "frothCreateContext");
  auto assetInfo = makeStruct<FrothAssetInfo>();
  assetInfo.path = options.asset.c_str();
  check(frothOpenAsset(context_, &assetInfo, &asset_), "frothOpenAsset");
  auto instanceInfo = makeStruct<FrothInstanceInfo>();
  instanceInfo.asset = asset_;
  check(frothCreateInstance(context_, &instanceInfo, &instance_), "frothCreateInstance");
  waitForAsset();
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = {view_.width, view_.height};
  viewInfo.lensClasses = contextInfo.lensClasses;
  check(frothCreateView(context_, &viewInfo, &froth_), "frothCreateView");
  image_ = take(host_->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, viewInfo.maxExtent));
  isReady_ = true;
}

BudgetBench::~BudgetBench() {
  frothDestroyContext(context_, UINT64_MAX);
  host_->destroyImage(image_);
}

void BudgetBench::waitForAsset() {
  auto status = makeStruct<FrothAssetStatus>();
  do {
    frame();
    check(frothGetAssetStatus(context_, asset_, &status), "frothGetAssetStatus");
    require(status.state != FROTH_ASSET_FAILED, options_.asset + ": FAILED");
  } while (status.state == FROTH_ASSET_OPENING);
}

void BudgetBench::frame() {
  auto info = makeStruct<FrothRenderInfo>();
  info.camera = cameraOf(view_);
  info.displayCoded = 1;
  info.nearRatio = static_cast<float>(view_.nearRatio.value_or(0));
  info.nearDepth = static_cast<float>(view_.nearDepth.value_or(0));
  if (isReady_) info.colour = host_->describe(image_);
  const Status submitted = host_->submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0};
    auto status = makeStruct<FrothFrameStatus>();
    check(frothUpdate(context_, &frame, &status), "frothUpdate");
    check(frothRecordUpload(context_, commands), "frothRecordUpload");
    if (!isReady_) return {};
    const auto record = options_.walks ? frothRecordWalk : frothRecordRaster;
    check(record(context_, froth_, commands, &info), "draw");
    heldBytes_ = status.deviceBytes;
    return {};
  });
  check(submitted);
}

BudgetBench::Drawn BudgetBench::draw(uint64_t viewBytes) {
  for (const bool isWhole : {true, false}) {
    check(frothSetBudget(context_, isWhole || viewBytes == 0 ? 0 : otherBytes_ + viewBytes), "frothSetBudget");
    for (int i = 0; i < 3; ++i) frame();
  }
  Drawn drawn{{view_.width, view_.height, 3, {}}, makeStruct<FrothViewStatus>()};
  const std::vector<float> texels = take(host_->readImage(image_));
  for (size_t i = 0; i < texels.size(); ++i) {
    if (i % 4 != 3) drawn.colour.values.push_back(texels[i]);
  }
  check(frothGetViewStatus(context_, froth_, &drawn.status), "frothGetViewStatus");
  otherBytes_ = heldBytes_ - drawn.status.deviceBytes;
  return drawn;
}

void BudgetBench::run() {
  constexpr uint32_t kOverflow = FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW;
  const Drawn whole = draw(0);
  uint64_t least = 0, most = whole.status.deviceBytes;
  for (int i = 0; i < kSearchSteps; ++i) {
    const uint64_t middle = (least + most) / 2;
    ((draw(middle).status.bits & kOverflow) != 0 ? least : most) = middle;
  }
  fmt::print("{}, view {}, {}x{}, {}: {} cells in view, {:.2f} MiB held, {:.2f} MiB wanted\n", host_->info.name,
             options_.view, view_.width, view_.height, options_.walks ? "walk" : "raster", whole.status.visibleCells,
             static_cast<double>(whole.status.deviceBytes) / (1 << 20), static_cast<double>(most) / (1 << 20));
  fmt::print("budget   MiB    cells  share  pairs lost  PSNR dB\n");
  for (const double part : kParts) {
    const Drawn drawn = draw(static_cast<uint64_t>(part * static_cast<double>(most)));
    fmt::print("{:5.0f}% {:6.2f} {:7} {:5.1f}%  {:>10}  {:7.2f}\n", 100 * part,
               static_cast<double>(drawn.status.deviceBytes) / (1 << 20), drawn.status.shownCells,
               100.0 * drawn.status.shownCells / drawn.status.visibleCells,
               (drawn.status.bits & FROTH_VIEW_PAIR_OVERFLOW) != 0 ? "yes" : "no",
               take(compareImages(drawn.colour, whole.colour)).psnr);
  }
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::Options options;
  CLI::App app("How a picture degrades when the device budget falls.");
  app.add_option("asset", options.asset)->required();
  app.add_option("cameras", options.cameras)->required();
  app.add_option("--view", options.view, "index in the cameras file");
  app.add_option("--width", options.width);
  app.add_option("--height", options.height);
  app.add_option("--device", options.device, "index or part of a name");
  app.add_flag("--walk", options.walks, "walks instead of raster");
  CLI11_PARSE(app, argc, argv);
  try {
    froth::BudgetBench(options).run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "froth_bench_budget: {}\n", error.what());
    return 1;
  }
  return 0;
}
