// Runs stiff cases through all renderers and bakes, and holds what they draw against the double reference.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "measure/stability/cases/stiff_case.h"
#include "measure/stability/forms.h"
#include "measure/stability/known_faults.h"
#include "measure/stability/walk_trace.h"

namespace froth {

// One renderer on the bake of one preset, over all views of a case.
struct RendererOutcome {
  std::string renderer{};    // Form::name
  bool isFinite = true;      // every value of every channel; and no -0
  bool isRepeatable = true;  // the same bits on a second run
  // of raster: how far all tiles long are from all tiles short, over one bound; drivers may fuse the two otherwise
  double tilesExcess = 0;
  bool endsInTime = true;   // no walk takes more steps than there are cells
  double maxError = 0;      // BoundCheck::maxError
  double worstExcess = 0;   // largest error over its pixel's bound; <= 1: within
  double colourExcess = 0;  // the same of colour and alpha alone
  double shareOver = 0;     // of the pixels of the worst view
  size_t worstView = 0;     // of the worst excess, and its pixel and channel
  uint32_t worstX = 0, worstY = 0;
  const char* worstChannel = "colour";
};

struct PresetOutcome {
  std::string preset;
  double boundLargest = 0, boundMean = 0;  // [display-coded] of forms in float
  std::vector<RendererOutcome> renderers;  // as formsOf()
  double rasterWalkExcess = 0;             // difference of raster and walk over one bound, not two
  WalkTrace walks;
  // of what the bake shows against the foam itself, both exact; least and largest of the views
  double encodingPsnr = 0, encodingMax = 0;
};

std::string placeText(const RendererOutcome& renderer);  // "view 0, pixel (3, 4), alpha"

// What is wrong with it: of images, and of the walks traced on the CPU (renderer "trace").
std::vector<SeenFault> faultsOf(const PresetOutcome& preset);
inline constexpr const char* kTraceRenderer = "trace";

enum class CaseVerdict { kWithin, kRefused, kKnown, kFails };
const char* verdictName(CaseVerdict verdict);

struct CaseOutcome {
  std::string refusal;  // the importer's message; empty: it was accepted
  std::vector<PresetOutcome> presets;
  std::vector<SeenFault> faults;         // none: it is within its bounds
  std::vector<std::string> unexplained;  // of these and of what is known of the case, all that makes it fail
  CaseVerdict verdict = CaseVerdict::kWithin;
};

const std::vector<std::string>& stabilityPresets();  // "exact" first

// One thread at a time.
class StabilityRunner {
 public:
  // `options` need the lens classes of all cases that will be run. Indices are always checked.
  static Result<std::unique_ptr<StabilityRunner>> create(const GpuDeviceOptions& options);

  // Fails only when it was asked to stop; all else is a fault of the case. Of what is known, that of other presets is
  // not asked for.
  Result<CaseOutcome> run(const StiffCase& stiff, const std::vector<std::string>& presets, const Progress& progress);
  // The bake of one preset alone, of a foam as it stands. Fails when it cannot be baked or drawn, too.
  Result<PresetOutcome> runOne(const StiffCase& stiff, const std::string& preset, const Progress& progress);
  const HostDeviceInfo& device() const { return renderer_->device(); }

 private:
  explicit StabilityRunner(std::unique_ptr<FormRenderer> renderer) : renderer_(std::move(renderer)) {}

  Status runPreset(const StiffCase& stiff, const Foam& foam, const std::vector<RenderedImages>& originals,
                   PresetOutcome& outcome, const Progress& progress);
  Status runView(const StiffCase& stiff, size_t index, const BakedCase& baked, PresetOutcome& outcome);

  std::unique_ptr<FormRenderer> renderer_;
};

}  // namespace froth
