#include "tests/render/layer_scene.h"

#include <algorithm>
#include <fstream>

#include "format/write/asset_writer.h"
#include "host/make_struct.h"
#include "tests/render/random_foam.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{64, 64};
constexpr int kMostFrames = 60, kSteadyFrames = 4;

void keepMessage(void* user, FrothSeverity severity, FrothResult code, const char* object, const char* text) {
  static_cast<std::vector<SceneMessage>*>(user)->push_back({severity, code, object, text});
}

FrothContextInfo contextInfo(LayerEngine& engine) {
  FrothContextInfo info = checkedContextInfo(0);
  info.onMessage = keepMessage;
  info.messageUser = &engine.messages;
  info.framesInFlight = 3;
  info.runJob = JobsOnDemand::take;
  info.jobUser = &engine.jobs;
  return info;
}

}  // namespace

void JobsOnDemand::take(void* user, FrothJob job, void* argument) {
  auto& jobs = *static_cast<JobsOnDemand*>(user);
  jobs.held.push_back({job, argument});
  if (!jobs.areHeld) jobs.runAll();
}

void JobsOnDemand::runAll() {
  while (!held.empty()) {
    const Given first = held.front();
    held.pop_front();
    first.job(first.argument);
  }
}

// Small cells, a part of them in view; most of their bytes are lobes.
const std::vector<uint8_t>& LayerScene::bytes() {
  static const std::vector<uint8_t> encoded = [] {
    Foam foam = makeRandomFoam(4000, 6, 4, 6);
    for (float& radius : foam.radii) radius *= 0.2f;
    return *encodeAsset(bakeForTest(foam));
  }();
  return encoded;
}

LayerEngine& LayerScene::engine() {
  static LayerEngine engine;
  return engine;
}

LayerScene::LayerScene() {
  std::string name = (std::filesystem::temp_directory_path() / "froth_layers_XXXXXX").string();
  folder_ = mkdtemp(name.data());
  std::ofstream(path(), std::ios::binary).write(reinterpret_cast<const char*>(bytes().data()), std::ssize(bytes()));
  if (!context_) {
    const FrothContextInfo info = contextInfo(engine());
    check(frothCreateContext(&info, &context_), "frothCreateContext");
  }
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = kExtent;
  check(frothCreateView(context_, &viewInfo, &view_), "frothCreateView");
  image_ = *sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
  info_ = infoOf(lookAt({0, 0, 0}, {0, 0, 3}, kExtent.width, kExtent.height, 0.2));
}

LayerScene::~LayerScene() {
  jobs_.areHeld = false;
  jobs_.runAll();
  lag_ = 1;
  if (context_) {
    setBudget(0);
    while (!placed_.empty()) close(placed_.front().first);
    draw();
    check(frothDestroyView(context_, view_), "frothDestroyView");
    view_ = {};
    for (int frame = 0; frame < 2; ++frame) drop();  // frees what is gone
  }
  engine().messages.clear();
  sharedHost().destroyImage(image_);
  std::filesystem::remove_all(folder_);
  for (const std::string& message : sharedHost().validationMessages()) ADD_FAILURE() << message;
  sharedHost().forgetValidationMessages();
}

FrothAsset LayerScene::open(uint32_t layers) {
  auto info = makeStruct<FrothAssetInfo>();
  const std::string file = path();
  info.path = file.c_str();
  info.layers = layers;
  info.keepForQueries = 1;
  return open(info);
}

FrothAsset LayerScene::open(FrothAssetInfo info) {
  info.layersMayGo = 1;
  FrothAsset asset{};
  check(frothOpenAsset(context_, &info, &asset), "frothOpenAsset");
  auto instanceInfo = makeStruct<FrothInstanceInfo>();
  instanceInfo.asset = asset;
  FrothInstance instance{};
  check(frothCreateInstance(context_, &instanceInfo, &instance), "frothCreateInstance");
  placed_.emplace_back(asset, instance);
  for (int frame = 0; frame < kMostFrames && statusOf(asset).state == FROTH_ASSET_OPENING; ++frame) draw();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  return asset;
}

void LayerScene::close(FrothAsset asset) {
  std::erase_if(placed_, [&](const auto& placed) {
    if (placed.first.index != asset.index) return false;
    check(frothDestroyInstance(context_, placed.second), "frothDestroyInstance");
    return true;
  });
  check(frothCloseAsset(context_, asset), "frothCloseAsset");
}

void LayerScene::restoreDevice() {
  const FrothContextInfo info = contextInfo(engine());
  check(frothRestoreDevice(context_, &info), "frothRestoreDevice");
}

FrothResult LayerScene::record(VkCommandBuffer commands, uint64_t serial, FrothFrameStatus& status) {
  auto frame = makeStruct<FrothFrame>();
  frame.serial = serial;
  frame.completedSerial = completedSerial_ = std::max(completedSerial_, serial - lag_);
  check(frothUpdate(context_, &frame, &status), "frothUpdate");
  check(frothRecordUpload(context_, commands), "frothRecordUpload");
  if (view_.generation == 0) return FROTH_OK;
  info_.colour = sharedHost().describe(image_);
  const FrothResult result = frothRecordRaster(context_, view_, commands, &info_);
  EXPECT_GE(result, FROTH_OK);
  return result;
}

Shown LayerScene::draw() {
  Shown shown{FROTH_OK, {}, makeStruct<FrothFrameStatus>()};
  EXPECT_TRUE(sharedHost().submit([&](VkCommandBuffer commands, uint64_t serial) {
    shown.result = record(commands, serial, shown.frame);
    return Status();
  }));
  shown.texels = *sharedHost().readImage(image_);
  return shown;
}

void LayerScene::drop() {
  auto status = makeStruct<FrothFrameStatus>();
  std::vector<uint64_t> serials;
  ++lag_;  // neither completes
  for (int frame = 0; frame < 2; ++frame) {
    const Status submitted = sharedHost().submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
      record(commands, serial, status);
      serials.push_back(serial);
      return makeError(ErrorKind::kCancelled, "never submitted");
    });
    EXPECT_FALSE(submitted);
  }
  --lag_;
  for (const uint64_t serial : serials) check(frothDropFrame(context_, serial), "frothDropFrame");
}

Shown LayerScene::drawUntilSteady() {
  Shown shown = draw();
  for (int frame = 0, steady = 0; frame < kMostFrames && steady < kSteadyFrames; ++frame) {
    Shown next = draw();
    steady = next.texels == shown.texels && next.frame.deviceBytes == shown.frame.deviceBytes ? steady + 1 : 0;
    shown = std::move(next);
  }
  return shown;
}

Shown LayerScene::drawUntilLayers(FrothAsset asset, uint32_t layers) {
  const std::vector<float>& whole = alone(statusOf(asset).layers).texels;
  for (int frame = 0; frame < kMostFrames; ++frame) {
    Shown shown = draw();
    EXPECT_EQ(viewStatus().bits & FROTH_VIEW_NOT_READY, 0u);
    if (layersOf(asset) == layers) return shown;
    EXPECT_TRUE(shown.result == FROTH_INCOMPLETE || shown.texels == whole) << "frame " << frame;
  }
  ADD_FAILURE() << layersOf(asset) << " layers, not " << layers;
  return draw();
}

FrothAssetStatus LayerScene::statusOf(FrothAsset asset) {
  auto status = makeStruct<FrothAssetStatus>();
  check(frothGetAssetStatus(context_, asset, &status), "frothGetAssetStatus");
  return status;
}

FrothViewStatus LayerScene::viewStatus() {
  auto status = makeStruct<FrothViewStatus>();
  check(frothGetViewStatus(context_, view_, &status), "frothGetViewStatus");
  EXPECT_EQ(status.indexViolations, 0u);
  return status;
}

FrothMemoryReport LayerScene::report() {
  auto report = makeStruct<FrothMemoryReport>();
  check(frothGetMemoryReport(context_, &report), "frothGetMemoryReport");
  return report;
}

std::vector<std::string> LayerScene::warnings() const {
  std::vector<std::string> texts;
  for (const SceneMessage& message : engine().messages) {
    const bool isOfView = message.object == "view";
    EXPECT_EQ(message.severity, isOfView ? FROTH_SEVERITY_ERROR : FROTH_SEVERITY_WARNING) << message.text;
    if (!isOfView) texts.push_back(message.object + ": " + message.text);
  }
  return texts;
}

// A view shows all instances of the context: these scenes come before all others.
const LayerScene::Alone& LayerScene::alone(uint32_t layers) {
  struct Scene : LayerScene {
    void TestBody() override {}
    Alone measure(uint32_t count) {
      const FrothAsset asset = open(count);
      const Shown shown = drawUntilSteady();
      EXPECT_EQ(shown.result, FROTH_OK);
      return {shown.texels, statusOf(asset).deviceBytes};
    }
  };
  static const std::vector<Alone> measured = [] {
    std::vector<Alone> all;
    for (const uint32_t count : {1u, 2u, 3u}) all.push_back(Scene().measure(count));
    return all;
  }();
  return measured[layers - 1];
}

uint64_t LayerScene::budgetFor(uint32_t layers, uint64_t bytes) const {
  return bytes - alone(3).bytes + alone(layers).bytes + alone(layers).bytes / 32;
}

}  // namespace froth::test
