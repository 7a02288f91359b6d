// An engine that embeds Froth and minds what every call returns: one asset, one instance, one view, frames of
// both methods.
#pragma once

#include <string>
#include <vector>

#include "froth/froth_reader.h"
#include "host/host.h"

namespace froth::test {

class Engine {
 public:
  // How the asset's bytes come: from memory, or through a reader that answers at once.
  enum class Source { kMemory, kReader };

  // host null: without a device.
  Engine(Host* host, const std::vector<uint8_t>& assetBytes, Source source = Source::kMemory)
      : host_(host), bytes_(assetBytes), source_(source) {}
  ~Engine();

  // Each gives what the call returned that failed first; then the rest of it was not done, and it can be
  // called again.
  FrothResult start();        // makes the context
  FrothResult makeObjects();  // those that are missing
  FrothResult drawFrame();
  FrothResult query();  // a ray, a point, a sphere
  FrothResult stop();

  // What the engine does about an error; false: the contract knows no way on.
  bool recover(FrothResult result);

  bool hasContext() const { return context_ != nullptr; }
  bool isAssetReady();  // a FAILED one is closed, to be opened again by makeObjects()

  std::vector<float> raster, walk;  // of the newest frame
  struct Message {
    FrothSeverity severity;
    FrothResult code;
    std::string text;
  };
  std::vector<Message> messages;

 private:
  FrothContextInfo contextInfo();
  FrothReader reader();
  FrothResult recordFrame(VkCommandBuffer commands);
  FrothRenderInfo renderInfo(const HostImage& image) const;

  Host* host_;
  const std::vector<uint8_t>& bytes_;
  Source source_;
  HostImage rasterImage_, walkImage_;
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  FrothInstance instance_{};
  FrothView view_{};
  uint64_t serial_ = 0;
};

}  // namespace froth::test
