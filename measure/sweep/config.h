// A configuration of everything that trades error for time or bytes, and the knobs that turn it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "baker/bake/bake.h"
#include "measure/gpu/gpu_renderer.h"
#include "measure/report/report.h"

namespace froth {

struct ReportConfig {
  // How the asset is made.
  BakeKnobs knobs;
  bool walkGraph = true, steiner = true;
  uint32_t detailsKept = 0;  // detail sites per cell; 0: all
  uint32_t copies = 1;       // of the foam, side by side (tileFoam)
  bool hasCameras = true;    // errors weigh by what the cameras see
  // How it is drawn.
  Method method = Method::kRaster;
  float cutoff = 1e-3f;  // 0: never
  uint32_t layers = 3;
  uint32_t maxSteps = 0;
  GpuStreaming streaming;
  double pixelSize = 1;  // pixels of the output per pixel drawn, along a side
};

// Equal for configurations that share an asset, or are the same altogether.
std::string encodingKey(const ReportConfig& config);
std::string configKey(const ReportConfig& config);

struct KnobValue {
  std::string text;
  double number = 0;
  std::function<void(ReportConfig&)> apply;
};

struct Knob {
  Sweep sweep;                 // without its points
  bool isConvergence = false;  // around the exact asset without a cut-off, and not timed; else around the default
  Method method = Method::kRaster;
  std::vector<KnobValue> values;
  // Of a lattice: the attribute, as the manifest names it, and the most that its values may lie from the input's, in
  // the manifest's unit: half a step along each axis.
  const char* attribute = nullptr;
  std::function<double(double bits, const Foam&)> mostError;
};

// Turn how an asset is made: they need the foam.
std::vector<Knob> encodingKnobs();
// Turn how it is drawn; walks: also those of the walk.
std::vector<Knob> drawingKnobs(bool walks);

// Turn which levels of detail are drawn, of an asset that has them. Budgets lie between what asset and view take of
// device memory with the floor alone, and with all cells [bytes].
std::vector<Knob> levelKnobs(uint64_t floorBytes, uint64_t wholeBytes);

// The default preset, and the exact asset at full precision.
ReportConfig defaultConfig();
ReportConfig exactConfig();

}  // namespace froth
