// Runs stiff cases through all renderers and bakes, and holds what they draw against the double reference.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "baker/progress.h"
#include "baker/stability/stiff_case.h"
#include "baker/stability/walk_trace.h"
#include "baker/tool/gpu_renderer.h"

namespace froth {

struct BakedCase;  // runs.cpp

// One renderer on the bake of one preset, over all views of a case.
struct RendererOutcome {
  std::string renderer{};     // "float", "raster", "walk"
  bool isFinite = true;       // every value of every channel; and no -0
  bool isRepeatable = true;   // the same bits on a second run
  bool endsInTime = true;     // no walk takes more steps than there are cells
  double maxError = 0;        // [display-coded] of colour
  double worstExcess = 0;     // largest error over its pixel's bound; <= 1: within
  double shareOver = 0;       // of the pixels of the worst view
  size_t worstView = 0;       // of the worst excess, and its pixel
  uint32_t worstX = 0, worstY = 0;
};

struct PresetOutcome {
  std::string preset;
  double boundLargest = 0, boundMean = 0;  // [display-coded]
  std::vector<RendererOutcome> renderers;  // float, raster, walk
  double rasterWalkExcess = 0;  // difference of raster and walk over twice the bound
  WalkTrace walks;
  double encodingPsnr = 0, encodingMax = 0;  // of what the bake shows against the foam itself, both exact; least and largest of the views
};

std::string placeText(const RendererOutcome& renderer);  // "view 0, pixel (3, 4)"

enum class CaseVerdict { kWithin, kRefused, kKnown, kFails };
const char* verdictName(CaseVerdict verdict);

struct CaseOutcome {
  std::string refusal;  // the importer's message; empty: it was accepted
  std::vector<PresetOutcome> presets;
  std::vector<std::string> faults;  // each with preset, renderer and figures; none: it is within its bounds
  CaseVerdict verdict = CaseVerdict::kWithin;
};

const std::vector<std::string>& stabilityPresets();  // "exact" first

// One thread at a time.
class StabilityRunner {
 public:
  // `options` need the lens classes of all cases that will be run.
  static Result<std::unique_ptr<StabilityRunner>> create(const GpuDeviceOptions& options);

  // Fails only when it was asked to stop; all else is a fault of the case.
  Result<CaseOutcome> run(const StiffCase& stiff, const Progress& progress);
  // The bake of one preset alone, of a foam as it stands. Fails when it cannot be baked or drawn, too.
  Result<PresetOutcome> runOne(const StiffCase& stiff, const std::string& preset, const Progress& progress);
  const HostDeviceInfo& device() const { return gpu_->device(); }

 private:
  explicit StabilityRunner(std::unique_ptr<GpuRenderer> gpu) : gpu_(std::move(gpu)) {}

  Status runPreset(const StiffCase& stiff, const Foam& foam, const std::vector<RenderedImages>& originals, PresetOutcome& outcome,
                   const Progress& progress);
  Status drawTwice(const StiffCase& stiff, size_t index, const BakedCase& baked, GpuMethod method, RendererOutcome& renderer,
                   RenderedImages& images);
  Status runView(const StiffCase& stiff, size_t index, const BakedCase& baked, PresetOutcome& outcome);

  std::unique_ptr<GpuRenderer> gpu_;
};

}  // namespace froth
