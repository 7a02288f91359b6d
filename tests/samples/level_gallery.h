// The gallery with levels of detail, for flights through it.
#pragma once

#include <cstdlib>
#include <string>

#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {

// In each test's folder: gallery.froth, baked once for all, and cameras.json. No window system.
class LevelGallery : public ToolTest {
 protected:
  void SetUp() override {
    if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    if (asset_.empty()) {
      frothWell({"synth", "gallery", "--cells", "20000", "-o", "gallery.pt"});
      frothWell({"bake", "gallery.pt", "--lod", "--chunk-cells", "1024", "--no-measure", "-o", "gallery.froth"});
      asset_ = readBytes(folder_ / "gallery.froth");
      cameras_ = readBytes(folder_ / "gallery.cameras.json");
    }
    writeBytes(folder_ / "gallery.froth", asset_);
    writeBytes(folder_ / "cameras.json", cameras_);
  }

 private:
  static inline std::string asset_, cameras_;  // bytes of their files; empty: not baked yet
};

}  // namespace froth::test
