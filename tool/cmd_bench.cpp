// froth bench: milliseconds by pass, from GPU timestamps; with --counters what the rays cost; with --flight what
// streaming does on the way; with --open how long a first image takes; with --rays what rays from anywhere cost.
#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "baker/input/foam_input.h"
#include "host/ray_preparation.h"
#include "measure/bench/bench_figures.h"
#include "measure/bench/ray_bench.h"
#include "measure/figures.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/gpu/gpu_renderer.h"
#include "reference/capture/view_selection.h"
#include "tool/bench_flight.h"
#include "tool/bench_open.h"
#include "tool/commands.h"
#include "tool/options.h"

namespace froth {
namespace {

struct RayFlags {
  bool isWanted = false;
  std::string prepared = "nothing";
};

struct BenchOptions {
  std::filesystem::path input;
  ViewOptions views;
  std::string renderer = "raster";
  float cutoff = 1e-3f;
  uint32_t maxEntries = 0;
  uint32_t frames = 200;
  double warmupSeconds = 1.0;  // clocks of an idle GPU take about this long to rise
  uint32_t layers = kAllLayers;
  std::string device;
  bool isCounting = false;
  FlightFlags flight;
  OpeningOptions opening;
  RayFlags rays;
  FiguresOutput figures;
};

GpuRenderOptions renderOptionsOf(const BenchOptions& options) {
  GpuRenderOptions render;
  render.method = findMethod(options.renderer)->method;
  render.cutoff = options.cutoff;
  render.maxEntries = options.maxEntries;
  return render;
}

// The noise of a measurement is how far its cycles over the views scatter.
constexpr uint32_t kLeastCycles = 5;

Status warmUp(GpuRenderer& renderer, const std::vector<SelectedView>& views, const GpuRenderOptions& options,
              double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  // Every view once at least: buffers grow to what the hungriest needs.
  for (size_t frame = 0; frame < views.size() || std::chrono::steady_clock::now() < end; ++frame) {
    const Result<FrothViewStatus> status = renderer.draw(views[frame % views.size()].view, options);
    if (!status) return status.error();
  }
  return {};
}

Result<Measurement> measure(GpuRenderer& renderer, const std::vector<SelectedView>& views,
                            const GpuRenderOptions& options, uint32_t cycles, const Progress& progress) {
  Measurement measurement;
  const size_t frames = cycles * views.size();
  measurement.viewTotals.resize(views.size());
  measurement.viewStatus.resize(views.size());
  for (size_t frame = 0; frame < frames; ++frame) {
    if (!report(progress, "measure", frame, frames)) return stoppedError();
    const size_t view = frame % views.size();
    const Result<FrothViewStatus> status = renderer.draw(views[view].view, options);
    if (!status) return status.error();
    if (status->passCount == 0) {
      return makeError(ErrorKind::kUnsupported, "device %s gives no timestamps on its compute queue; pick another",
                       renderer.device().name.c_str());
    }
    addFrame(measurement, view, *status);
  }
  return measurement;
}

Status runRays(GpuRenderer& renderer, const std::vector<SelectedView>& views, const RayBenchOptions& casting,
               const BenchOptions& options, const Progress& progress) {
  const Result<std::vector<RayFigures>> figures = benchRays(renderer, views, casting, progress);
  if (!figures) return figures.error();
  const FrothAssetStatus status = renderer.assetStatus();
  const View& view = views.front().view;
  if (options.figures.wantsTable()) {
    fmt::print("rays on {} ({}), {} cells, {:.1f} MB, prepared: {}, {}x{}, cut-off {}, {} frames of {} views\n",
               renderer.device().name, renderer.device().driver, status.cellCount,
               1e-6 * static_cast<double>(status.deviceBytes), options.rays.prepared, view.width, view.height,
               options.cutoff, casting.frames, views.size());
    if (options.isCounting) fmt::print("counting: the times are not those of casting\n");
    printRays(*figures, options.isCounting);
  }
  const nlohmann::ordered_json json{{"input", options.input.string()},
                                    {"device", renderer.device().name},
                                    {"driver", renderer.device().driver},
                                    {"prepared", options.rays.prepared},
                                    {"cutoff", options.cutoff},
                                    {"width", view.width},
                                    {"height", view.height},
                                    {"views", views.size()},
                                    {"frames", casting.frames},
                                    {"isCounting", options.isCounting},
                                    {"cells", status.cellCount},
                                    {"assetBytes", status.deviceBytes},
                                    {"memory", memoryAsJson(status, {})["asset"]},
                                    {"rays", raysAsJson(*figures, options.isCounting)}};
  return options.figures.write(json);
}

Status runBench(const BenchOptions& options, const Progress& progress) {
  if (Status good = checkLayers(options.input, options.layers); !good) return good;
  const Result<std::vector<SelectedView>> views = selectViews(options.views);
  if (!views) return views.error();
  const Result<AssetInput> asset = loadAsset(options.input, progress, options.layers);
  if (!asset) return asset.error();
  GpuDeviceOptions device;
  device.device = options.device;
  device.measurePasses = true;
  device.castsRays = options.rays.isWanted;
  device.prepareRays = kRayPreparations.at(options.rays.prepared);
  device.countWork = options.isCounting;
  device.lensClasses = lensClassesOf(*views);
  Result<std::unique_ptr<GpuRenderer>> created = GpuRenderer::create(device);
  if (!created) return created.error();
  GpuRenderer& renderer = **created;
  if (Status loaded = renderer.load(*asset, progress); !loaded) return loaded;

  GpuRenderOptions render = renderOptionsOf(options);
  render.isLinear = true;
  const auto viewCount = static_cast<uint32_t>(views->size());
  const uint32_t cycles = std::max(kLeastCycles, (options.frames + viewCount - 1) / viewCount);
  if (Status warm = warmUp(renderer, *views, render, options.warmupSeconds); !warm) return warm;
  if (options.rays.isWanted) {
    return runRays(renderer, *views, {options.cutoff, cycles}, options, progress);
  }
  const Result<Measurement> measurement = measure(renderer, *views, render, cycles, progress);
  if (!measurement) return measurement.error();

  const FrothAssetStatus status = renderer.assetStatus();
  const View& view = views->front().view;
  const FrothViewStatus& viewStatus = measurement->viewStatus.back();  // buffers only grow
  if (options.figures.wantsTable()) {
    fmt::print("{} on {} ({}), {} cells, {}x{}, cut-off {}, {} frames over {} views\n", options.renderer,
               renderer.device().name, renderer.device().driver, status.cellCount, view.width, view.height,
               options.cutoff, measurement->totals.size(), views->size());
    if (options.isCounting) fmt::print("counting: the times are not those of drawing\n");
    printMeasurement(*measurement);
    if (options.isCounting) printWork(*measurement, *views);
    printMemory(status, viewStatus);
  }
  nlohmann::ordered_json figures{{"input", options.input.string()},
                                 {"device", renderer.device().name},
                                 {"driver", renderer.device().driver},
                                 {"renderer", options.renderer},
                                 {"output", "linear colour, rgba16f"},
                                 {"cutoff", options.cutoff},
                                 {"maxEntries", options.maxEntries},
                                 {"width", view.width},
                                 {"height", view.height},
                                 {"layers", options.layers},
                                 {"frames", measurement->totals.size()},
                                 {"isCounting", options.isCounting},
                                 {"cells", status.cellCount},
                                 {"assetBytes", status.deviceBytes},
                                 {"viewBytes", viewStatus.deviceBytes},
                                 {"memory", memoryAsJson(status, viewStatus)}};
  if (options.isCounting) figures["work"] = workAsJson(*measurement, *views);
  figures.update(measurementAsJson(*measurement, *views));
  return options.figures.write(figures);
}

Status benchFlight(const BenchOptions& options, const Progress& progress) {
  FlightFlags flags = options.flight;
  flags.flight.device = options.device;
  flags.flight.scene.asset = options.input;
  flags.flight.scene.render = renderOptionsOf(options);
  return runFlight(flags, options.views, options.figures, progress);
}

void addRayFlags(CLI::App& command, RayFlags& flags) {
  constexpr const char* kGroup = "Rays";
  command.add_flag("--rays", flags.isWanted, "Cast rays from the views and from what they see, instead of drawing")
      ->excludes("--flight")
      ->excludes("--open")
      ->group(kGroup);
  command.add_option("--prepare", flags.prepared, "What is kept in device memory for rays")
      ->capture_default_str()
      ->check(CLI::IsMember(&kRayPreparations))
      ->needs("--rays")
      ->group(kGroup);
}

Status benchOpen(const BenchOptions& options, const Progress& progress) {
  OpeningOptions opening = options.opening;
  opening.asset = options.input.string();
  opening.device = options.device;
  opening.render = renderOptionsOf(options);
  return runOpen(opening, options.views, options.figures, progress);
}

Status runWanted(const BenchOptions& options, const Progress& progress) {
  if (options.flight.flight.frames > 0) return benchFlight(options, progress);
  if (options.opening.runs > 0) return benchOpen(options, progress);
  return runBench(options, progress);
}

}  // namespace

void addBenchCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("bench", "Measure GPU time by pass over the views");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("INPUT", options->input, "A .froth file or a checkpoint")->required();
  command->add_option("--cameras", options->views.cameras, kCamerasHelp)->required();
  addViewOptions(*command, options->views);
  command->add_option("--renderer", options->renderer, "How")
      ->capture_default_str()
      ->check(CLI::IsMember(methodNames()));
  command->add_option("--cutoff", options->cutoff, "A ray ends below this transmittance")
      ->capture_default_str()
      ->check(numberBetween(0, 1));
  command
      ->add_option("--max-entries", options->maxEntries,
                   "Longest list of a tile, as FrothRenderInfo::maxEntries; 0: 16384")
      ->check(countBetween(0, UINT32_MAX));
  command->add_option("--frames", options->frames, "Least measured frames; whole cycles through the views, 5 at least")
      ->capture_default_str()
      ->check(countBetween(100, 1000000));
  addDurationOption(*command, "--warmup", options->warmupSeconds, "Drawing before the first measured frame", 0, 3600);
  command->add_flag("--counters", options->isCounting, "Count what the rays cost; slower");
  addLayersOption(*command, options->layers);
  command->add_option("--device", options->device, "Index or part of a name (`froth devices`)");
  addFiguresOption(*command, options->figures);
  addFlightOptions(*command, options->flight);
  addOpenOptions(*command, options->opening);
  addRayFlags(*command, options->rays);
  command->callback(
      [&tool, options] { tool.action = [&tool, options] { return runWanted(*options, tool.progress.callback()); }; });
}

}  // namespace froth
