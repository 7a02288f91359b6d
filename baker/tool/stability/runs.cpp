#include "baker/tool/stability/runs.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "baker/bake/bake.h"
#include "baker/checkpoint/checkpoint.h"
#include "baker/graph/graph.h"
#include "baker/image/metrics.h"
#include "baker/stability/image_bound.h"
#include "format/asset_reader.h"
#include "format/asset_writer.h"
#include "format/atomic_file.h"

namespace froth {

// An asset, and the foam that it holds relative to `base`, so that no float of it is larger than the scene.
struct BakedCase {
  AssetInput asset;
  glm::dvec3 base{0};
  Foam foam;
  std::unique_ptr<ReferenceRenderer> reference;  // of `foam`
};

namespace {

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

Result<AssetContents> readContents(const std::vector<uint8_t>& bytes) {
  const Result<AssetReader> reader = AssetReader::openBytes(bytes, "asset");
  if (!reader) return reader.error();
  AssetContents contents = reader->manifest();
  for (uint32_t chunk = 0; chunk < contents.chunks.size(); ++chunk) {
    Result<ChunkContents> read = reader->readChunk(chunk);
    if (!read) return read.error();
    contents.chunks[chunk] = std::move(*read);
  }
  return contents;
}

Status bakeCase(const Foam& foam, const std::string& preset, BakedCase& baked, const Progress& progress) {
  BakeOptions options;
  options.preset = preset;
  options.knobs = *presetKnobs(preset);
  options.nearRatio = 0;
  options.measure = false;
  options.source = "stability";
  const Result<BakeResult> result = bakeFoam(foam, options, progress);
  if (!result) return result.error();
  Result<std::vector<uint8_t>> bytes = encodeAsset(result->contents);
  if (!bytes) return bytes.error();
  baked.asset.bytes = std::move(*bytes);
  Result<AssetContents> contents = readContents(baked.asset.bytes);
  if (!contents) return contents.error();

  const auto& origin = contents->chunks.front().origin;
  baked.base = {origin[0], origin[1], origin[2]};
  for (ChunkContents& chunk : contents->chunks) {
    for (int axis = 0; axis < 3; ++axis) chunk.origin[axis] -= baked.base[axis];
  }
  Result<Foam> decoded = foamFromAsset(*contents);
  if (!decoded) return decoded.error();
  baked.foam = std::move(*decoded);
  baked.reference = std::make_unique<ReferenceRenderer>(baked.foam);
  return {};
}

void addCheck(const BoundCheck& check, size_t view, RendererOutcome& renderer) {
  renderer.isFinite = renderer.isFinite && check.isFinite;
  renderer.maxError = std::max(renderer.maxError, check.maxError);
  renderer.shareOver = std::max(renderer.shareOver, check.shareOver);
  if (check.worstExcess <= renderer.worstExcess) return;
  renderer.worstExcess = check.worstExcess;
  renderer.worstView = view;
  renderer.worstX = check.worstX;
  renderer.worstY = check.worstY;
}

bool hasSameBits(const RenderedImages& a, const RenderedImages& b) {
  return a.colour.values == b.colour.values && a.alpha.values == b.alpha.values && a.depth.values == b.depth.values &&
         a.normal.values == b.normal.values;
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
  for (const char* renderer : {"float", "raster", "walk"}) outcome.renderers.push_back({renderer});
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

void findFaults(const PresetOutcome& preset, std::vector<std::string>& faults) {
  for (const RendererOutcome& run : preset.renderers) {
    const std::string who = preset.preset + ", " + run.renderer;
    if (!run.isFinite) faults.push_back(who + ": a value is not finite, or -0");
    if (!run.isRepeatable) faults.push_back(who + ": a second run gives other bits");
    if (!run.endsInTime) faults.push_back(who + ": walks take more steps than there are cells");
    if (run.worstExcess > 1)
      faults.push_back(fmt::format("{}: {:.3g} times the bound at {}, {:.2g} % of the pixels over it", who, run.worstExcess,
                                   placeText(run), 100 * run.shareOver));
  }
  if (preset.rasterWalkExcess > 1)
    faults.push_back(fmt::format("{}: raster and walk differ by {:.3g} times what their bounds allow", preset.preset, preset.rasterWalkExcess));
  if (preset.walks.violations > 0)
    faults.push_back(fmt::format("{}: {} of {} steps of walks do not increase d . p", preset.preset, preset.walks.violations, preset.walks.steps));
  if (preset.walks.lost > 0)
    faults.push_back(fmt::format("{}: {} of {} walks end before the last cell", preset.preset, preset.walks.lost, preset.walks.rays));
}

CaseVerdict judge(const StiffCase& stiff, const CaseOutcome& outcome) {
  if (!stiff.refusal.empty() && outcome.faults.empty()) return CaseVerdict::kRefused;
  if (outcome.faults.empty()) return CaseVerdict::kWithin;
  return stiff.knownCause.empty() ? CaseVerdict::kFails : CaseVerdict::kKnown;
}

}  // namespace

std::string placeText(const RendererOutcome& renderer) {
  return fmt::format("view {}, pixel ({}, {})", renderer.worstView, renderer.worstX, renderer.worstY);
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
  Result<std::unique_ptr<GpuRenderer>> gpu = GpuRenderer::create(options);
  if (!gpu) return gpu.error();
  return std::unique_ptr<StabilityRunner>(new StabilityRunner(std::move(*gpu)));
}

// Draws by a method twice.
Status StabilityRunner::drawTwice(const StiffCase& stiff, size_t index, const BakedCase& baked, GpuMethod method,
                                  RendererOutcome& renderer, RenderedImages& images) {
  const View view = movedBy(stiff.moved, stiff.views[index]);
  GpuRenderOptions options;
  options.method = method;
  options.cutoff = 0;
  options.maxSteps = baked.foam.cellCount;
  Result<GpuFrame> frame = gpu_->render(view, options);
  if (!frame) return frame.error();
  const Result<GpuFrame> again = gpu_->render(view, options);
  if (!again) return again.error();
  renderer.isRepeatable = renderer.isRepeatable && hasSameBits(frame->images, again->images);
  renderer.endsInTime = renderer.endsInTime && (frame->status.bits & FROTH_VIEW_STEP_LIMIT) == 0;
  images = std::move(frame->images);
  return {};
}

Status StabilityRunner::runView(const StiffCase& stiff, size_t index, const BakedCase& baked, PresetOutcome& outcome) {
  const View view = movedBy(-baked.base, stiff.views[index]);
  ReferenceOptions options = referenceOptions(view);
  options.precision = Precision::kFloat;
  Result<RenderedImages> inFloat = baked.reference->render(view, options);
  if (!inFloat) return inFloat.error();
  std::array<RenderedImages, 3> drawn = {std::move(*inFloat), {}, {}};  // as PresetOutcome::renderers
  if (Status done = drawTwice(stiff, index, baked, GpuMethod::kRaster, outcome.renderers[1], drawn[1]); !done) return done;
  if (Status done = drawTwice(stiff, index, baked, GpuMethod::kWalk, outcome.renderers[2], drawn[2]); !done) return done;

  BoundOptions boundOptions;
  boundOptions.storageError = stiff.storageError;
  for (;;) {
    const Result<ImageBound> bound = boundImage(*baked.reference, view, options, boundOptions);
    if (!bound) return bound.error();
    std::array<BoundCheck, 3> checks;
    for (size_t i = 0; i < checks.size(); ++i) checks[i] = checkBound(*bound, drawn[i]);
    const bool isOver = std::any_of(checks.begin(), checks.end(), [](const BoundCheck& check) { return check.worstExcess > 1; });
    if (isOver && boundOptions.samples < kSurerSamples) {
      boundOptions.samples = kSurerSamples;
      continue;
    }
    outcome.boundLargest = std::max(outcome.boundLargest, bound->largest);
    outcome.boundMean = std::max(outcome.boundMean, bound->mean);
    for (size_t i = 0; i < checks.size(); ++i) addCheck(checks[i], index, outcome.renderers[i]);
    outcome.rasterWalkExcess = std::max(outcome.rasterWalkExcess, checkBound(*bound, drawn[1], drawn[2]).worstExcess);
    return {};
  }
}

Status StabilityRunner::runPreset(const StiffCase& stiff, const Foam& foam, const std::vector<RenderedImages>& originals,
                                  PresetOutcome& outcome, const Progress& progress) {
  BakedCase baked;
  if (Status status = bakeCase(foam, outcome.preset, baked, progress); !status) return status;
  const Result<RegularTriangulation> triangulation = triangulateRegular(baked.foam.sites, baked.foam.radii);
  if (!triangulation) return triangulation.error();
  if (Status loaded = gpu_->load(baked.asset, progress, stiff.moved); !loaded) return loaded;
  outcome.encodingPsnr = std::numeric_limits<double>::infinity();
  for (size_t index = 0; index < stiff.views.size(); ++index) {
    if (Status run = runView(stiff, index, baked, outcome); !run) return run;
    const View view = movedBy(-baked.base, stiff.views[index]);
    addTrace(traceWalks(baked.foam, triangulation->graph, view), outcome.walks);
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

Result<CaseOutcome> StabilityRunner::run(const StiffCase& stiff, const Progress& progress) {
  CaseOutcome outcome;
  Foam foam = stiff.foam;
  if (stiff.isImported) {
    Result<Foam> imported = importCase(stiff.foam);
    if (!imported) outcome.refusal = imported.error().message;
    if (outcome.refusal.find(stiff.refusal) == std::string::npos || outcome.refusal.empty() != stiff.refusal.empty())
      outcome.faults.push_back(imported ? "it is imported" : "it is refused: " + outcome.refusal);
    if (imported) foam = std::move(*imported);
  }
  if (outcome.refusal.empty()) {
    const Result<std::vector<RenderedImages>> originals = drawOriginals(foam, stiff.views, progress);
    if (!originals) return originals.error();
    for (const std::string& preset : stabilityPresets()) {
      outcome.presets.push_back(outcomeOf(preset));
      const Status run = runPreset(stiff, foam, *originals, outcome.presets.back(), progress);
      if (!run && run.error().kind == ErrorKind::kCancelled) return run.error();
      if (!run) outcome.faults.push_back(preset + ": " + run.error().message);
      findFaults(outcome.presets.back(), outcome.faults);
    }
  }
  outcome.verdict = judge(stiff, outcome);
  return outcome;
}

}  // namespace froth
