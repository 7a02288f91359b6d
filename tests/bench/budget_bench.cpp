// froth_bench_budget ASSET CAMERAS [options]: how a picture degrades when the device budget falls.
//
// Draws one view with all the memory that it wants, finds the least of asset and view with which nothing is missing,
// and then sets budgets that are parts of that, first for an asset whose layers stay, then for one that gives
// them up. For each, once it is settled: the layers, the memory, the cells shown, and the PSNR against the whole
// picture.
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/input_file.h"
#include "froth/froth.h"
#include "host/host.h"
#include "host/make_struct.h"
#include "measure/gpu/gpu_camera.h"
#include "reference/image/metrics.h"
#include "tests/bench/bench_calls.h"

namespace froth {
namespace {

constexpr double kParts[] = {1, 0.85, 0.7, 0.55, 0.4, 0.3};
constexpr int kSearchSteps = 6;    // to a 64th of the view's memory
constexpr int kSettledFrames = 5;  // that hold the same

double toMebi(uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

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
    FrothViewStatus view;
    FrothAssetStatus asset;
  };

  void open(bool keepsLayers);
  void close();
  void frame();
  void settle(uint64_t budget);
  Drawn draw(uint64_t budget);  // 0: none
  uint64_t findLeast(const Drawn& whole);
  void printRows(const char* name, uint64_t wanted, const Drawn& whole);
  FrothAssetStatus assetStatus();

  Options options_;
  View view_;
  std::unique_ptr<Host> host_;
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  FrothInstance instance_{};
  FrothView froth_{};
  HostImage image_{};
  std::vector<uint8_t> bytes_;
  uint64_t heldBytes_ = 0;
};

BudgetBench::BudgetBench(const Options& options) : options_(options) {
  const CameraSet cameras = take(readCameras(options.cameras));
  view_ = resizeView(cameras.views.at(options.view), options.width, options.height);
  host_ = take(Host::create({.device = options.device}));
  FrothContextInfo contextInfo = host_->contextInfo();
  contextInfo.lensClasses = lensClassesOf(view_);
  check(frothCreateContext(&contextInfo, &context_), "frothCreateContext");
  const InputFile file = take(InputFile::open(options.asset));
  bytes_.resize(file.size());
  check(file.readAt(0, bytes_));
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = {view_.width, view_.height};
  viewInfo.lensClasses = contextInfo.lensClasses;
  check(frothCreateView(context_, &viewInfo, &froth_), "frothCreateView");
  image_ = take(host_->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, viewInfo.maxExtent));
}

BudgetBench::~BudgetBench() {
  frothDestroyContext(context_, UINT64_MAX);
  host_->destroyImage(image_);
}

void BudgetBench::open(bool keepsLayers) {
  auto assetInfo = makeStruct<FrothAssetInfo>();
  assetInfo.data = bytes_.data();
  assetInfo.dataSize = bytes_.size();
  assetInfo.bytesStay = 1;
  assetInfo.layersMayGo = keepsLayers ? 0 : 1;
  check(frothSetBudget(context_, 0), "frothSetBudget");  // an asset that does not fit is FAILED
  check(frothOpenAsset(context_, &assetInfo, &asset_), "frothOpenAsset");
  auto instanceInfo = makeStruct<FrothInstanceInfo>();
  instanceInfo.asset = asset_;
  check(frothCreateInstance(context_, &instanceInfo, &instance_), "frothCreateInstance");
  while (assetStatus().state == FROTH_ASSET_OPENING) frame();
  require(assetStatus().state == FROTH_ASSET_READY, options_.asset + ": FAILED");
}

void BudgetBench::close() {
  check(frothDestroyInstance(context_, instance_), "frothDestroyInstance");
  check(frothCloseAsset(context_, asset_), "frothCloseAsset");
}

FrothAssetStatus BudgetBench::assetStatus() {
  auto status = makeStruct<FrothAssetStatus>();
  check(frothGetAssetStatus(context_, asset_, &status), "frothGetAssetStatus");
  return status;
}

void BudgetBench::frame() {
  auto info = makeStruct<FrothRenderInfo>();
  info.camera = cameraOf(view_);
  info.displayCoded = 1;
  info.nearRatio = static_cast<float>(view_.nearRatio.value_or(0));
  info.nearDepth = static_cast<float>(view_.nearDepth.value_or(0));
  info.colour = host_->describe(image_);
  const Status submitted = host_->submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
    auto status = makeStruct<FrothFrameStatus>();
    check(frothUpdate(context_, &frame, &status), "frothUpdate");
    check(frothRecordUpload(context_, commands), "frothRecordUpload");
    const auto record = options_.walks ? frothRecordWalk : frothRecordRaster;
    check(record(context_, froth_, commands, &info), "draw");
    heldBytes_ = status.deviceBytes;
    return {};
  });
  check(submitted);
}

void BudgetBench::settle(uint64_t budget) {
  check(frothSetBudget(context_, budget), "frothSetBudget");
  for (int settled = 0; settled < kSettledFrames; ++settled) {
    const uint64_t before = heldBytes_;
    frame();
    if (heldBytes_ != before) settled = 0;
  }
}

BudgetBench::Drawn BudgetBench::draw(uint64_t budget) {
  settle(0);
  if (budget != 0) settle(budget);
  Drawn drawn{{view_.width, view_.height, 3, {}}, makeStruct<FrothViewStatus>(), assetStatus()};
  const std::vector<float> texels = take(host_->readImage(image_));
  for (size_t i = 0; i < texels.size(); ++i) {
    if (i % 4 != 3) drawn.colour.values.push_back(texels[i]);
  }
  check(frothGetViewStatus(context_, froth_, &drawn.view), "frothGetViewStatus");
  return drawn;
}

// [bytes] of asset and view with which nothing is missing.
uint64_t BudgetBench::findLeast(const Drawn& whole) {
  constexpr uint32_t kOverflow = FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW;
  uint64_t least = whole.asset.deviceBytes, most = least + whole.view.deviceBytes;
  for (int i = 0; i < kSearchSteps; ++i) {
    const uint64_t middle = (least + most) / 2;
    ((draw(middle).view.bits & kOverflow) != 0 ? least : most) = middle;
  }
  return most;
}

void BudgetBench::printRows(const char* name, uint64_t wanted, const Drawn& whole) {
  fmt::print("{}\nbudget   held layers  asset   view   cells  share  pairs lost  PSNR dB\n", name);
  for (const double part : kParts) {
    const Drawn drawn = draw(static_cast<uint64_t>(part * static_cast<double>(wanted)));
    fmt::print("{:5.0f}% {:6.2f} {:6} {:6.2f} {:6.2f} {:7} {:5.1f}%  {:>10}  {:7.2f}\n", 100 * part, toMebi(heldBytes_),
               drawn.asset.layers, toMebi(drawn.asset.deviceBytes), toMebi(drawn.view.deviceBytes),
               drawn.view.shownCells, 100.0 * drawn.view.shownCells / drawn.view.visibleCells,
               (drawn.view.bits & FROTH_VIEW_PAIR_OVERFLOW) != 0 ? "yes" : "no",
               take(compareImages(drawn.colour, whole.colour)).psnr);
    std::fflush(stdout);
  }
}

void BudgetBench::run() {
  open(true);
  const Drawn whole = draw(0);
  const uint64_t wanted = findLeast(whole);
  fmt::print("{}, view {}, {}x{}, {}: {} cells in view, {:.2f} MiB held, {:.2f} MiB wanted\n", host_->info.name,
             options_.view, view_.width, view_.height, options_.walks ? "walk" : "raster", whole.view.visibleCells,
             toMebi(whole.asset.deviceBytes + whole.view.deviceBytes), toMebi(wanted));
  printRows("only cells go", wanted, whole);
  close();
  open(false);
  printRows("layers go, then cells", wanted, whole);
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
