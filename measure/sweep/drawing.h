// Draws and times assets for a report: on the GPU through the runtime, or on the CPU.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "measure/gpu/gpu_renderer.h"
#include "measure/report/report.h"

namespace froth {

// One asset, drawn one way.
struct Draw {
  std::filesystem::path asset;
  uint32_t layers = 3;
  GpuRenderOptions options;
  std::vector<View> views;
  GpuStreaming streaming{};
};

struct DrawTimes {
  Interval total;                 // [ms] a frame, mean over the views
  std::vector<PassTimes> passes;  // empty on the CPU
  uint64_t residentBytes = 0;     // asset and view; 0 on the CPU
  // Most of a view; 0 on the CPU.
  DrawnChunks drawn{};
  uint64_t viewBytes = 0;
};

// A round draws at least three cycles over the views, and all rounds at least `frames` frames.
struct Rounds {
  uint32_t count = 3;
  uint32_t frames = 50;
  uint64_t seed = 1;  // of the order in each
};

class SweepRenderer {
 public:
  virtual ~SweepRenderer() = default;
  virtual std::string device() const = 0;
  virtual std::string driver() const = 0;
  // Colour, opacity, distance, normal of every view.
  virtual Result<std::vector<RenderedImages>> render(const Draw& draw, const Progress& progress) = 0;
  // Times all draws in each round, in an order of its own, so that slow changes of the device meet all alike.
  virtual Result<std::vector<DrawTimes>> time(const std::vector<Draw>& draws, const Rounds& rounds,
                                              const Progress& progress) = 0;
};

Interval intervalOf(const std::vector<double>& cycles);
uint32_t cyclesOf(const Draw& draw, const Rounds& rounds);  // of one round
std::vector<size_t> orderOf(const std::vector<Draw>& draws, const Rounds& rounds, uint32_t round);

Result<std::unique_ptr<SweepRenderer>> createGpuSweepRenderer(
    GpuDeviceOptions options);  // passes are measured whatever they say
std::unique_ptr<SweepRenderer> createCpuSweepRenderer();

}  // namespace froth
