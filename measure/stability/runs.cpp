#include "measure/stability/runs.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "foam/checkpoint/checkpoint.h"
#include "measure/stability/case_judge.h"
#include "measure/stability/forms.h"
#include "measure/stability/image_bound.h"
#include "reference/camera/view_rays.h"
#include "reference/image/metrics.h"
#include "shaders/foam/appearance.h"

namespace froth {
namespace {

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

Result<std::vector<RenderedImages>> drawOriginals(const StiffCase& stiff, const Foam& foam, const Progress& progress) {
  std::vector<RenderedImages> originals;
  const ReferenceRenderer reference(foam);
  for (size_t index = 0; index < stiff.views.size(); ++index) {
    Result<RenderedImages> images = reference.render(stiff.views[index], optionsOfCase(stiff, index), progress);
    if (!images) return images.error();
    originals.push_back(std::move(*images));
  }
  return originals;
}

PresetOutcome outcomeOf(const StiffCase& stiff, const std::string& preset) {
  PresetOutcome outcome;
  outcome.preset = preset;
  for (const Form& form : formsOf(stiff, preset)) outcome.renderers.push_back({form.name});
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
  if (run.tilesExcess > 1) {
    append("another image by tiles", run.tilesExcess,
           fmt::format("long and short tiles differ by {:.3g} times the bound", run.tilesExcess));
  }
  if (!run.endsInTime) append("steps", 0, "walks take more steps than there are cells");
  if (run.worstExcess > 1) {
    append("over its bound", run.worstExcess,
           fmt::format("{:.3g} times the bound at {}, {:.2g} % of the pixels over it; largest error {:.3g}",
                       run.worstExcess, placeText(run), 100 * run.shareOver, run.maxError));
  }
}

CaseVerdict judge(const StiffCase& stiff, const CaseOutcome& outcome) {
  if (!outcome.unexplained.empty()) return CaseVerdict::kFails;
  if (!stiff.refusal.empty()) return CaseVerdict::kRefused;
  return outcome.faults.empty() ? CaseVerdict::kWithin : CaseVerdict::kKnown;
}

}  // namespace

std::string placeText(const RendererOutcome& renderer) {
  return fmt::format("view {}, pixel ({}, {}), {}", renderer.worstView, renderer.worstX, renderer.worstY,
                     renderer.worstChannel);
}

std::vector<SeenFault> faultsOf(const PresetOutcome& preset) {
  std::vector<SeenFault> faults;
  for (const RendererOutcome& run : preset.renderers) appendFaults(preset, run, faults);
  const auto append = [&](const char* renderer, const char* kind, double factor, const std::string& text) {
    faults.push_back({preset.preset, renderer, kind, factor, preset.preset + ": " + text});
  };
  if (preset.rasterWalkExcess > 1) {
    append("raster and walk", "over its bound", preset.rasterWalkExcess,
           fmt::format("raster and walk differ by {:.3g} times the bound", preset.rasterWalkExcess));
  }
  const WalkTrace& walks = preset.walks;
  if (walks.violations > 0) {
    append(kTraceRenderer, "order", 0,
           fmt::format("{} of {} steps of walks do not increase d . p", walks.violations, walks.steps));
  }
  if (walks.lost > 0) {
    append(kTraceRenderer, "lost", 0, fmt::format("{} of {} walks end before the last cell", walks.lost, walks.rays));
  }
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

namespace {

// Of one view, for the forms that are drawn of it.
struct FormBounds {
  ImageBound whole, shipped, rays;
};

const ImageBound& boundOf(const Form& form, const FormBounds& bounds) {
  if (form.kind == FormKind::kRays || form.kind == FormKind::kQueries) return bounds.rays;
  return form.isShipped ? bounds.shipped : bounds.whole;
}

// Rays that are cast one by one know no near limits, leave out detail sites of little weight, and are given distances
// as they are.
Result<FormBounds> boundForms(const ReferenceDraw& draw, const ReferenceOptions& options,
                              const BoundOptions& boundOptions) {
  Result<ImageBound> whole = boundImage(draw, options, boundOptions);
  if (!whole) return whole.error();
  ReferenceOptions cut = options, all = options;
  cut.cutoff = 2 * kShippedCutoff;
  const Result<RenderedImages> atTwice = draw(cut);
  if (!atTwice) return atTwice.error();
  FormBounds bounds{std::move(*whole), {}, {}};
  bounds.shipped = boundShippedForm(bounds.whole, *atTwice);
  all.nearRatio = all.nearDepth = 0;
  all.depthAxis = glm::dvec3(0);
  all.leastShare = foam::leastShownShare<double>();
  const Result<ImageBound> ofRays = boundImage(draw, all, boundOptions);
  if (!ofRays) return ofRays.error();
  bounds.rays = boundOfRays(*ofRays);
  return bounds;
}

// What a view's forms keep of their bounds.
struct ViewChecks {
  std::vector<BoundCheck> forms;    // as the forms
  std::vector<double> tilesExcess;  // the same; 0: no raster
  BoundCheck apart;                 // of raster and walk

  bool isOver() const {
    return apart.worstExcess > 1 || std::ranges::max(tilesExcess) > 1 ||
           std::ranges::any_of(forms, [](const BoundCheck& check) { return check.worstExcess > 1; });
  }
};

ViewChecks checkForms(const std::vector<Form>& forms, const std::vector<DrawnForm>& drawn, const FormBounds& bounds) {
  ViewChecks checks;
  const RenderedImages *raster = nullptr, *walk = nullptr;
  for (size_t i = 0; i < forms.size(); ++i) {
    const ImageBound& own = boundOf(forms[i], bounds);
    const RenderedImages& images = drawn[i].images;
    checks.forms.push_back(checkBound(own, images));
    checks.tilesExcess.push_back(drawn[i].inLongTiles ? checkBound(own, images, *drawn[i].inLongTiles).worstExcess : 0);
    if (forms[i].kind == FormKind::kRaster && !forms[i].isShipped) raster = &images;
    if (forms[i].kind == FormKind::kWalk && !forms[i].isShipped) walk = &images;
  }
  checks.apart = checkBound(bounds.whole, *raster, *walk);
  return checks;
}

}  // namespace

Result<std::unique_ptr<StabilityRunner>> StabilityRunner::create(const GpuDeviceOptions& options) {
  Result<std::unique_ptr<FormRenderer>> renderer = FormRenderer::create(options);
  if (!renderer) return renderer.error();
  return std::unique_ptr<StabilityRunner>(new StabilityRunner(std::move(*renderer)));
}

Status StabilityRunner::runView(const StiffCase& stiff, size_t index, const BakedCase& baked, PresetOutcome& outcome) {
  const std::vector<Form> forms = formsOf(stiff, outcome.preset);
  std::vector<DrawnForm> drawn;
  for (size_t i = 0; i < forms.size(); ++i) {
    Result<DrawnForm> form = renderer_->draw(forms[i], stiff, index);
    if (!form) return form.error();
    outcome.renderers[i].isRepeatable = outcome.renderers[i].isRepeatable && form->isRepeatable;
    outcome.renderers[i].endsInTime = outcome.renderers[i].endsInTime && form->endsInTime;
    drawn.push_back(std::move(*form));
  }
  const View view = caseViewOf(stiff, index, baked).ofFoam;
  const ReferenceDraw draw = [&](const ReferenceOptions& options) { return drawExactly(baked, view, options); };
  ReferenceOptions options = optionsOfCase(stiff, index);
  if (view.lens.kind == LensKind::kPinhole) options.depthAxis = forwardOf(view);  // device depth, as of an engine
  BoundOptions boundOptions;
  for (;;) {
    const Result<FormBounds> bounds = boundForms(draw, options, boundOptions);
    if (!bounds) return bounds.error();
    const ViewChecks checks = checkForms(forms, drawn, *bounds);
    if (checks.isOver() && boundOptions.samples < kSurerSamples) {
      boundOptions.samples = kSurerSamples;
      continue;
    }
    outcome.boundLargest = std::max(outcome.boundLargest, bounds->whole.largest);
    outcome.boundMean = std::max(outcome.boundMean, bounds->whole.mean);
    for (size_t i = 0; i < forms.size(); ++i) {
      addCheck(checks.forms[i], index, outcome.renderers[i]);
      outcome.renderers[i].tilesExcess = std::max(outcome.renderers[i].tilesExcess, checks.tilesExcess[i]);
    }
    outcome.rasterWalkExcess = std::max(outcome.rasterWalkExcess, checks.apart.worstExcess);
    return {};
  }
}

Status StabilityRunner::runPreset(const StiffCase& stiff, const Foam& foam,
                                  const std::vector<RenderedImages>& originals, PresetOutcome& outcome,
                                  const Progress& progress) {
  BakedCase baked;
  if (Status status = bakeCase(stiff, foam, outcome.preset, baked, progress); !status) return status;
  if (Status loaded = renderer_->load(stiff, baked, isDrawnAsShipped(outcome.preset), progress); !loaded) return loaded;
  outcome.encodingPsnr = std::numeric_limits<double>::infinity();
  for (size_t index = 0; index < stiff.views.size(); ++index) {
    if (Status run = runView(stiff, index, baked, outcome); !run) return run;
    const View view = caseViewOf(stiff, index, baked).ofFoam;
    addTrace(traceWalks(baked.foam, baked.walkGraph, view), outcome.walks);
    const Result<RenderedImages> decoded = baked.reference->render(view, optionsOfCase(stiff, index));
    if (!decoded) return decoded.error();
    const Result<ImageDifference> encoding = compareImages(decoded->colour, originals[index].colour);
    if (!encoding) return encoding.error();
    outcome.encodingPsnr = std::min(outcome.encodingPsnr, encoding->psnr);
    outcome.encodingMax = std::max(outcome.encodingMax, encoding->maxError);
  }
  return {};
}

Result<PresetOutcome> StabilityRunner::runOne(const StiffCase& stiff, const std::string& preset,
                                              const Progress& progress) {
  const Result<std::vector<RenderedImages>> originals = drawOriginals(stiff, stiff.foam, progress);
  if (!originals) return originals.error();
  PresetOutcome outcome = outcomeOf(stiff, preset);
  if (Status run = runPreset(stiff, stiff.foam, *originals, outcome, progress); !run) return run.error();
  return outcome;
}

Result<CaseOutcome> StabilityRunner::run(const StiffCase& stiff, const std::vector<std::string>& presets,
                                         const Progress& progress) {
  CaseOutcome outcome;
  Foam foam = stiff.foam;
  if (stiff.isImported) {
    Result<Foam> imported = importCase(stiff.foam);
    if (!imported) outcome.refusal = imported.error().message;
    if (outcome.refusal.find(stiff.refusal) == std::string::npos || outcome.refusal.empty() != stiff.refusal.empty()) {
      outcome.faults.push_back(
          {"", "import", "refusal", 0, imported ? "it is imported" : "it is refused: " + outcome.refusal});
    }
    if (imported) foam = std::move(*imported);
  }
  if (outcome.refusal.empty()) {
    const Result<std::vector<RenderedImages>> originals = drawOriginals(stiff, foam, progress);
    if (!originals) return originals.error();
    for (const std::string& preset : presets) {
      outcome.presets.push_back(outcomeOf(stiff, preset));
      const Status run = runPreset(stiff, foam, *originals, outcome.presets.back(), progress);
      if (!run && run.error().kind == ErrorKind::kCancelled) return run.error();
      if (!run) outcome.faults.push_back({preset, "device", "error", 0, preset + ": " + run.error().message});
      const std::vector<SeenFault> faults = faultsOf(outcome.presets.back());
      outcome.faults.insert(outcome.faults.end(), faults.begin(), faults.end());
    }
  }
  std::vector<KnownFault> known = stiff.known;
  std::erase_if(known, [&](const KnownFault& fault) {
    return std::find(presets.begin(), presets.end(), fault.preset) == presets.end();
  });
  outcome.unexplained = unexplainedFaults(known, outcome.faults);
  outcome.verdict = judge(stiff, outcome);
  return outcome;
}

}  // namespace froth
