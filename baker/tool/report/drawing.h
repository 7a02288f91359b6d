// Draws and times assets for a report: on the GPU through the runtime, or on the CPU.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "baker/report/report.h"
#include "baker/tool/gpu_renderer.h"

namespace froth {

// One asset, drawn one way.
struct Draw {
  std::filesystem::path asset;
  uint32_t layers = 3;
  GpuRenderOptions options;
  std::vector<View> views;
};

struct DrawTimes {
  Interval total;                 // [ms] a frame, mean over the views
  std::vector<PassTimes> passes;  // empty on the CPU
  uint64_t residentBytes = 0;     // asset and view; 0 on the CPU
};

class Drawer {
 public:
  virtual ~Drawer() = default;
  virtual std::string device() const = 0;
  virtual std::string driver() const = 0;
  // Colour, opacity, depth, normal of every view.
  virtual Result<std::vector<RenderedImages>> render(const Draw& draw, const Progress& progress) = 0;
  // Times all draws in turn, `rounds` times over, so that slow changes of the device meet all alike; a round draws at least three
  // cycles over the views, and all rounds at least `frames` frames.
  virtual Result<std::vector<DrawTimes>> time(const std::vector<Draw>& draws, uint32_t rounds, uint32_t frames,
                                              const Progress& progress) = 0;
};

// `device`: index or part of a name; empty: the first suitable one.
Result<std::unique_ptr<Drawer>> createGpuDrawer(const std::string& device, uint32_t lensClasses);
std::unique_ptr<Drawer> createCpuDrawer();

}  // namespace froth
