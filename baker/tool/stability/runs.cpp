#include "baker/tool/stability/runs.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "baker/checkpoint/checkpoint.h"
#include "baker/image/metrics.h"
#include "baker/stability/image_bound.h"
#include "baker/tool/stability/baked_case.h"
#include "format/atomic_file.h"

namespace froth {
// What a renderer draws of a view.
struct DrawnForms {
  RenderedImages images;  // of a raster: with all tiles short
  std::optional<RenderedImages> inLongTiles;  // of a raster
};

namespace {

// The forms on the device, as in PresetOutcome::renderers after "float".
struct DeviceForm {
  const char* renderer;
  GpuMethod method;
  bool isShipped;
};
constexpr DeviceForm kForms[] = {{"raster", GpuMethod::kRaster, false},
                                 {"walk", GpuMethod::kWalk, false},
                                 {"raster shipped", GpuMethod::kRaster, true},
                                 {"walk shipped", GpuMethod::kWalk, true}};
enum RendererIndex : size_t { kFloat, kRaster, kWalk, kRasterShipped };
constexpr double kShippedCutoff = 1e-3;
// The form that games draw is drawn from these bakes alone: it differs from the others by what no bake changes, and costs as much.
bool isDrawnAsShipped(const std::string& preset) { return preset == "exact" || preset == "default"; }

ReferenceOptions referenceOptions(const View& view) {
  ReferenceOptions options;
  options.nearRatio = view.nearRatio.value_or(4);
  options.nearDepth = view.nearDepth.value_or(0);
  return options;
}

View movedBy(const glm::dvec3& by, View view) {
  for (int axis = 0; axis < 3; ++axis) view.worldFromCamera[4 * axis + 3] += by[axis];
  return view;
}

void addCheck(const BoundCheck& check, size_t view, RendererOutcome& renderer) {
  renderer.isFinite = renderer.isFinite && check.isFinite;
  renderer.maxError = std::max(renderer.maxError, check.maxError);
  renderer.colourExcess = std::max(renderer.colourExcess, check.colourExcess);
  renderer.shareOver = std::max(renderer.shareOver, check.shareOver);
  if (check.worstExcess <= renderer.worstExcess) return;
  renderer.worstExcess = check.worstExcess;
  renderer.worstView = view;
  renderer.worstX = check.worstX;
  renderer.worstY = check.worstY;
  renderer.worstChannel = check.worstChannel;
}

void addTrace(const WalkTrace& trace, WalkTrace& sum) {
  sum.rays += trace.rays;
  sum.steps += trace.steps;
  sum.mostSteps = std::max(sum.mostSteps, trace.mostSteps);
  sum.violations += trace.violations;
  sum.lost += trace.lost;
}

Result<std::vector<RenderedImages>> drawOriginals(const Foam& foam, const std::vector<View>& views, const Progress& progress) {
  std::vector<RenderedImages> originals;
  const ReferenceRenderer reference(foam);
  for (const View& view : views) {
    Result<RenderedImages> images = reference.render(view, referenceOptions(view), progress);
    if (!images) return images.error();
    originals.push_back(std::move(*images));
  }
  return originals;
}

PresetOutcome outcomeOf(const std::string& preset) {
  PresetOutcome outcome;
  outcome.preset = preset;
  outcome.renderers.push_back({"float"});
  for (const DeviceForm& form : kForms) {
    if (!form.isShipped || isDrawnAsShipped(preset)) outcome.renderers.push_back({form.renderer});
  }
  return outcome;
}

// The foam as it comes back from a checkpoint.
Result<Foam> importCase(const Foam& foam) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("froth_stability_{}.pt", getpid());
  if (Status written = exportUnchecked(path, foam); !written) return written.error();
  const Result<std::vector<uint8_t>> bytes = readFile(path);
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  if (!bytes) return bytes.error();
  return importCheckpointBytes(*bytes, "case.pt");
}

void appendFaults(const PresetOutcome& preset, const RendererOutcome& run, std::vector<SeenFault>& faults) {
  const std::string who = preset.preset + ", " + run.renderer + ": ";
  const auto append = [&](const char* kind, double factor, const std::string& text) {
    faults.push_back({preset.preset, run.renderer, kind, factor, who + text});
  };
  if (!run.isFinite) append("not finite", 0, "a value is not finite, or -0");
  if (!run.isRepeatable) append("another image", 0, "a second run gives other bits");
  if (run.tilesExcess > 1)
    append("another image by tiles", run.tilesExcess, fmt::format("long and short tiles differ by {:.3g} times the bound", run.tilesExcess));
  if (!run.endsInTime) append("steps", 0, "walks take more steps than there are cells");
  if (run.worstExcess > 1) {
    append("over its bound", run.worstExcess,
           fmt::format("{:.3g} times the bound at {}, {:.2g} % of the pixels over it; largest error {:.3g}", run.worstExcess,
                       placeText(run), 100 * run.shareOver, run.maxError));
  }
}

CaseVerdict judge(const StiffCase& stiff, const CaseOutcome& outcome) {
  if (!outcome.unexplained.empty()) return CaseVerdict::kFails;
  if (!stiff.refusal.empty()) return CaseVerdict::kRefused;
  return outcome.faults.empty() ? CaseVerdict::kWithin : CaseVerdict::kKnown;
}

}  // namespace

std::string placeText(const RendererOutcome& renderer) {
  return fmt::format("view {}, pixel ({}, {}), {}", renderer.worstView, renderer.worstX, renderer.worstY, renderer.worstChannel);
}

std::vector<SeenFault> faultsOf(const PresetOutcome& preset) {
  std::vector<SeenFault> faults;
  for (const RendererOutcome& run : preset.renderers) appendFaults(preset, run, faults);
  const auto append = [&](const char* renderer, const char* kind, double factor, const std::string& text) {
    faults.push_back({preset.preset, renderer, kind, factor, preset.preset + ": " + text});
  };
  if (preset.rasterWalkExcess > 1)
    append("raster and walk", "over its bound", preset.rasterWalkExcess,
           fmt::format("raster and walk differ by {:.3g} times the bound", preset.rasterWalkExcess));
  const WalkTrace& walks = preset.walks;
  if (walks.violations > 0)
    append(kTraceRenderer, "order", 0, fmt::format("{} of {} steps of walks do not increase d . p", walks.violations, walks.steps));
  if (walks.lost > 0)
    append(kTraceRenderer, "lost", 0, fmt::format("{} of {} walks end before the last cell", walks.lost, walks.rays));
  return faults;
}

const char* verdictName(CaseVerdict verdict) {
  switch (verdict) {
    case CaseVerdict::kWithin:
      return "within";
    case CaseVerdict::kRefused:
      return "refused";
    case CaseVerdict::kKnown:
      return "falls short";
    case CaseVerdict::kFails:
      break;
  }
  return "FAILS";
}

const std::vector<std::string>& stabilityPresets() {
  static const std::vector<std::string> presets = {"exact", "high", "default", "small"};
  return presets;
}

Result<std::unique_ptr<StabilityRunner>> StabilityRunner::create(const GpuDeviceOptions& options) {
  GpuDeviceOptions floats = options;
  floats.checkIndices = floats.floatColours = true;
  Result<std::unique_ptr<GpuRenderer>> inFloat = GpuRenderer::create(floats);
  if (!inFloat) return inFloat.error();
  GpuDeviceOptions shipped = options;
  shipped.validate = false;  // as in a game; layers see the same calls in the other context
  Result<std::unique_ptr<GpuRenderer>> asShipped = GpuRenderer::create(shipped);
  if (!asShipped) return asShipped.error();
  return std::unique_ptr<StabilityRunner>(new StabilityRunner(std::move(*inFloat), std::move(*asShipped)));
}

// Twice in the same way, and a raster with all tiles in the other form.
Status StabilityRunner::drawRepeatedly(const View& view, uint32_t cellCount, RendererOutcome& outcome, DrawnForms& drawn) {
  const DeviceForm& form = *std::find_if(std::begin(kForms), std::end(kForms),
                                         [&](const DeviceForm& one) { return outcome.renderer == one.renderer; });
  GpuRenderOptions options;
  options.method = form.method;
  options.tileForm = FROTH_TILE_FORM_ALL_SHORT;
  options.cutoff = form.isShipped ? static_cast<float>(kShippedCutoff) : 0.0f;
  options.maxSteps = form.isShipped ? 0 : cellCount;
  const auto draw = [&] { return form.isShipped ? asShipped_->renderColour(view, options) : inFloat_->render(view, options); };
  Result<GpuFrame> first = draw();
  if (!first) return first.error();
  const Result<GpuFrame> again = draw();
  if (!again) return again.error();
  outcome.isRepeatable = outcome.isRepeatable && hasSameBits(first->images, again->images);
  outcome.endsInTime = outcome.endsInTime && (first->status.bits & FROTH_VIEW_STEP_LIMIT) == 0;
  drawn.images = std::move(first->images);
  if (form.method != GpuMethod::kRaster) return {};
  options.tileForm = FROTH_TILE_FORM_ALL_LONG;
  Result<GpuFrame> inLongTiles = draw();
  if (!inLongTiles) return inLongTiles.error();
  drawn.inLongTiles = std::move(inLongTiles->images);
  return {};
}

Status StabilityRunner::runView(const StiffCase& stiff, size_t index, const BakedCase& baked, PresetOutcome& outcome) {
  const View view = movedBy(-baked.base, stiff.views[index]), placed = movedBy(stiff.moved, stiff.views[index]);
  ReferenceOptions options = referenceOptions(view);
  options.precision = Precision::kFloat;
  Result<RenderedImages> inFloat = baked.reference->render(view, options);
  if (!inFloat) return inFloat.error();
  std::vector<DrawnForms> drawn(outcome.renderers.size());
  drawn[kFloat].images = std::move(*inFloat);
  for (size_t i = kRaster; i < drawn.size(); ++i) {
    if (Status done = drawRepeatedly(placed, baked.foam.cellCount, outcome.renderers[i], drawn[i]); !done) return done;
  }
  ReferenceOptions cut = referenceOptions(view);
  cut.cutoff = 2 * kShippedCutoff;
  const Result<RenderedImages> atTwice = baked.reference->render(view, cut);
  if (!atTwice) return atTwice.error();

  BoundOptions boundOptions;
  for (;;) {
    const Result<ImageBound> bound = boundImage(*baked.reference, view, options, boundOptions);
    if (!bound) return bound.error();
    const ImageBound shipped = boundShippedForm(*bound, *atTwice);
    std::vector<BoundCheck> checks(drawn.size());
    std::vector<double> tilesExcess(drawn.size(), 0.0);
    for (size_t i = 0; i < checks.size(); ++i) {
      const ImageBound& own = i < kRasterShipped ? *bound : shipped;
      checks[i] = checkBound(own, drawn[i].images);
      if (drawn[i].inLongTiles) tilesExcess[i] = checkBound(own, drawn[i].images, *drawn[i].inLongTiles).worstExcess;
    }
    const BoundCheck apart = checkBound(*bound, drawn[kRaster].images, drawn[kWalk].images);
    const bool isOver = apart.worstExcess > 1 || std::ranges::max(tilesExcess) > 1 ||
                        std::ranges::any_of(checks, [](const BoundCheck& check) { return check.worstExcess > 1; });
    if (isOver && boundOptions.samples < kSurerSamples) {
      boundOptions.samples = kSurerSamples;
      continue;
    }
    outcome.boundLargest = std::max(outcome.boundLargest, bound->largest);
    outcome.boundMean = std::max(outcome.boundMean, bound->mean);
    for (size_t i = 0; i < checks.size(); ++i) {
      addCheck(checks[i], index, outcome.renderers[i]);
      outcome.renderers[i].tilesExcess = std::max(outcome.renderers[i].tilesExcess, tilesExcess[i]);
    }
    outcome.rasterWalkExcess = std::max(outcome.rasterWalkExcess, apart.worstExcess);
    return {};
  }
}

Status StabilityRunner::runPreset(const StiffCase& stiff, const Foam& foam, const std::vector<RenderedImages>& originals,
                                  PresetOutcome& outcome, const Progress& progress) {
  BakedCase baked;
  if (Status status = bakeCase(foam, outcome.preset, stiff.chunkCells, baked, progress); !status) return status;
  if (Status loaded = inFloat_->load(baked.asset, progress, stiff.moved); !loaded) return loaded;
  if (isDrawnAsShipped(outcome.preset)) {
    if (Status loaded = asShipped_->load(baked.asset, progress, stiff.moved); !loaded) return loaded;
  }
  outcome.encodingPsnr = std::numeric_limits<double>::infinity();
  for (size_t index = 0; index < stiff.views.size(); ++index) {
    if (Status run = runView(stiff, index, baked, outcome); !run) return run;
    const View view = movedBy(-baked.base, stiff.views[index]);
    addTrace(traceWalks(baked.foam, baked.walkGraph, view), outcome.walks);
    const Result<RenderedImages> decoded = baked.reference->render(view, referenceOptions(view));
    if (!decoded) return decoded.error();
    const Result<ImageDifference> encoding = compareImages(decoded->colour, originals[index].colour);
    if (!encoding) return encoding.error();
    outcome.encodingPsnr = std::min(outcome.encodingPsnr, encoding->psnr);
    outcome.encodingMax = std::max(outcome.encodingMax, encoding->maxError);
  }
  return {};
}

Result<PresetOutcome> StabilityRunner::runOne(const StiffCase& stiff, const std::string& preset, const Progress& progress) {
  const Result<std::vector<RenderedImages>> originals = drawOriginals(stiff.foam, stiff.views, progress);
  if (!originals) return originals.error();
  PresetOutcome outcome = outcomeOf(preset);
  if (Status run = runPreset(stiff, stiff.foam, *originals, outcome, progress); !run) return run.error();
  return outcome;
}

Result<CaseOutcome> StabilityRunner::run(const StiffCase& stiff, const std::vector<std::string>& presets, const Progress& progress) {
  CaseOutcome outcome;
  Foam foam = stiff.foam;
  if (stiff.isImported) {
    Result<Foam> imported = importCase(stiff.foam);
    if (!imported) outcome.refusal = imported.error().message;
    if (outcome.refusal.find(stiff.refusal) == std::string::npos || outcome.refusal.empty() != stiff.refusal.empty())
      outcome.faults.push_back({"", "import", "refusal", 0, imported ? "it is imported" : "it is refused: " + outcome.refusal});
    if (imported) foam = std::move(*imported);
  }
  if (outcome.refusal.empty()) {
    const Result<std::vector<RenderedImages>> originals = drawOriginals(foam, stiff.views, progress);
    if (!originals) return originals.error();
    for (const std::string& preset : presets) {
      outcome.presets.push_back(outcomeOf(preset));
      const Status run = runPreset(stiff, foam, *originals, outcome.presets.back(), progress);
      if (!run && run.error().kind == ErrorKind::kCancelled) return run.error();
      if (!run) outcome.faults.push_back({preset, "device", "error", 0, preset + ": " + run.error().message});
      const std::vector<SeenFault> faults = faultsOf(outcome.presets.back());
      outcome.faults.insert(outcome.faults.end(), faults.begin(), faults.end());
    }
  }
  std::vector<KnownFault> known = stiff.known;
  std::erase_if(known, [&](const KnownFault& fault) { return std::find(presets.begin(), presets.end(), fault.preset) == presets.end(); });
  outcome.unexplained = unexplainedFaults(known, outcome.faults);
  outcome.verdict = judge(stiff, outcome);
  return outcome;
}

}  // namespace froth
