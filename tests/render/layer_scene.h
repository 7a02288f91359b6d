// A foam with layers to lose, in a context whose budget the test sets.
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/render_harness.h"

namespace froth::test {

// Jobs of a context: run at once where they are given, or held until the test runs them.
struct JobsOnDemand {
  struct Given {
    FrothJob job;
    void* argument;
  };
  std::deque<Given> held;
  bool areHeld = false;

  static void take(void* user, FrothJob job, void* argument);
  void runAll();
};

struct SceneMessage {
  FrothSeverity severity;
  FrothResult code;
  std::string object, text;
};

// What all scenes share: pipelines take long to make.
struct LayerEngine {
  FrothContext* context = nullptr;  // made by the next scene where there is none
  std::vector<SceneMessage> messages{};
  JobsOnDemand jobs{};
};

// What a frame drew.
struct Shown {
  FrothResult result;
  std::vector<float> texels;
  FrothFrameStatus frame;
};

class LayerScene : public testing::Test {
 protected:
  LayerScene();
  ~LayerScene() override;

  static void SetUpTestSuite() { alone(3); }

  static const std::vector<uint8_t>& bytes();  // of the asset
  std::string path() const { return (folder_ / "scene.froth").string(); }

  static LayerEngine& engine();

  // From the file; placed and READY.
  FrothAsset open(uint32_t layers = 0);
  FrothAsset open(FrothAssetInfo info);
  void close(FrothAsset asset);

  // A frame that is complete before the next.
  Shown draw();
  // Two frames that are recorded and never submitted; told when both are recorded.
  void drop();
  // On the same device, without a budget.
  void restoreDevice();
  Shown drawUntilSteady();
  // Until then; every frame is whole, or says that something is missing.
  Shown drawUntilLayers(FrothAsset asset, uint32_t layers);
  uint32_t layersOf(FrothAsset asset) { return statusOf(asset).layers; }
  FrothAssetStatus statusOf(FrothAsset asset);
  FrothViewStatus viewStatus();
  FrothMemoryReport report();
  uint64_t viewBytes() { return report().categories[1].granted; }
  void setBudget(uint64_t bytes) { check(frothSetBudget(context_, bytes), "frothSetBudget"); }
  // Of assets and the budget. Views too tell when the budget has no room for them, as errors.
  std::vector<std::string> warnings() const;

  // What the asset shows, and holds, that is opened with so many layers.
  struct Alone {
    std::vector<float> texels;
    uint64_t bytes;
  };
  static const Alone& alone(uint32_t layers);

  // With room for what views hold beside the asset of so many layers, where it holds `bytes` with all.
  uint64_t budgetFor(uint32_t layers, uint64_t bytes) const;
  uint64_t budgetFor(uint32_t layers) { return budgetFor(layers, report().deviceBytes); }
  // One that views can obey, with half of what they hold.
  uint64_t budgetOfFewerCells() { return report().deviceBytes - viewBytes() / 2; }

  FrothContext*& context_ = engine().context;
  JobsOnDemand& jobs_ = engine().jobs;
  FrothView view_{};
  FrothRenderInfo info_{};
  uint64_t lag_ = 1;  // frames after which one is told to be complete

 private:
  FrothResult record(VkCommandBuffer commands, uint64_t serial, FrothFrameStatus& status);

  std::filesystem::path folder_;
  HostImage image_;
  uint64_t completedSerial_ = 0;
  std::vector<std::pair<FrothAsset, FrothInstance>> placed_;
};

}  // namespace froth::test
