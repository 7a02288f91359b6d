// froth bench: milliseconds by pass, from GPU timestamps.
#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "baker/tool/commands.h"
#include "baker/tool/figures.h"
#include "baker/tool/foam_input.h"
#include "baker/tool/gpu_renderer.h"
#include "baker/tool/option_checks.h"
#include "baker/tool/view_selection.h"

namespace froth {
namespace {

struct BenchOptions {
  std::filesystem::path input;
  ViewOptions views;
  std::string renderer = "raster";
  float cutoff = 1e-3f;
  uint32_t frames = 200;
  double warmupSeconds = 1.0;  // clocks of an idle GPU take about this long to rise
  uint32_t layers = kAllLayers;
  std::string device;
  FiguresOutput figures;
};

struct Percentiles {
  double median = 0, p5 = 0, p95 = 0;
};

// Nearest rank; `values` not empty.
Percentiles percentilesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.05), at(0.95)};
}

nlohmann::ordered_json toJson(const Percentiles& times) {
  return {{"median", times.median}, {"p5", times.p5}, {"p95", times.p95}};
}

// All measured frames; a pass that a frame lacks counts nothing there.
struct Measurement {
  std::vector<std::string> passOrder;
  std::map<std::string, std::vector<double>> passTimes;  // [ms]
  std::vector<double> totals;                            // [ms] of all frames
  std::vector<std::vector<double>> viewTotals;           // [ms] by view
  std::vector<FrothViewStatus> viewStatus;               // newest, by view
};

void addFrame(Measurement& measurement, size_t view, const FrothViewStatus& status) {
  double total = 0;
  for (uint32_t pass = 0; pass < status.passCount; ++pass) {
    const FrothPassTime& time = status.passes[pass];
    auto [entry, isNew] = measurement.passTimes.try_emplace(time.name);
    if (isNew) measurement.passOrder.push_back(time.name);
    entry->second.push_back(time.milliseconds);
    total += time.milliseconds;
  }
  measurement.totals.push_back(total);
  measurement.viewTotals[view].push_back(total);
  measurement.viewStatus[view] = status;
}

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
                            const GpuRenderOptions& options, uint32_t frames, const Progress& progress) {
  Measurement measurement;
  measurement.viewTotals.resize(views.size());
  measurement.viewStatus.resize(views.size());
  for (uint32_t frame = 0; frame < frames; ++frame) {
    if (!report(progress, "measure", frame, frames)) return stoppedError();
    const size_t view = frame % views.size();
    const Result<FrothViewStatus> status = renderer.draw(views[view].view, options);
    if (!status) return status.error();
    if (status->passCount == 0) {
      return makeError(ErrorKind::kUnsupported,
                       "device %s gives no timestamps on its compute queue; pick another",
                       renderer.device().name.c_str());
    }
    addFrame(measurement, view, *status);
  }
  return measurement;
}

void printMeasurement(const Measurement& measurement) {
  fmt::print("{:<12} {:>10} {:>10} {:>10}  ms\n", "pass", "median", "p5", "p95");
  for (const std::string& name : measurement.passOrder) {
    const Percentiles times = percentilesOf(measurement.passTimes.at(name));
    fmt::print("{:<12} {:>10.4f} {:>10.4f} {:>10.4f}\n", name, times.median, times.p5, times.p95);
  }
  const Percentiles total = percentilesOf(measurement.totals);
  fmt::print("{:<12} {:>10.4f} {:>10.4f} {:>10.4f}\n", "total", total.median, total.p5, total.p95);
}

nlohmann::ordered_json measurementAsJson(const Measurement& measurement,
                                         const std::vector<SelectedView>& views) {
  nlohmann::ordered_json passes = nlohmann::ordered_json::object();
  for (const std::string& name : measurement.passOrder) {
    passes[name] = toJson(percentilesOf(measurement.passTimes.at(name)));
  }
  nlohmann::ordered_json perView = nlohmann::ordered_json::array();
  for (size_t i = 0; i < views.size(); ++i) {
    if (measurement.viewTotals[i].empty()) continue;  // more views than frames
    const FrothViewStatus& status = measurement.viewStatus[i];
    perView.push_back({{"view", views[i].index},
                       {"total", toJson(percentilesOf(measurement.viewTotals[i]))},
                       {"visibleCells", status.visibleCells},
                       {"pairs", status.pairs},
                       {"stepLimit", (status.bits & FROTH_VIEW_STEP_LIMIT) != 0}});
  }
  const double sum = std::accumulate(measurement.totals.begin(), measurement.totals.end(), 0.0);
  nlohmann::ordered_json total = toJson(percentilesOf(measurement.totals));
  total["mean"] = sum / static_cast<double>(measurement.totals.size());
  return {{"unit", "ms"}, {"total", total}, {"passes", passes}, {"views", perView}};
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
  Result<std::unique_ptr<GpuRenderer>> created = GpuRenderer::create(device, *asset, progress);
  if (!created) return created.error();
  GpuRenderer& renderer = **created;

  GpuRenderOptions render;
  render.method = options.renderer == "walk" ? GpuMethod::kWalk : GpuMethod::kRaster;
  render.cutoff = options.cutoff;
  render.isLinear = true;
  if (Status warm = warmUp(renderer, *views, render, options.warmupSeconds); !warm) return warm;
  const Result<Measurement> measurement = measure(renderer, *views, render, options.frames, progress);
  if (!measurement) return measurement.error();

  const FrothAssetStatus status = renderer.assetStatus();
  const View& view = views->front().view;
  const uint64_t viewBytes = measurement->viewStatus.front().deviceBytes;
  if (options.figures.wantsTable()) {
    fmt::print("{} on {} ({}), {} cells, {}x{}, cut-off {}, {} frames over {} views\n", options.renderer,
               renderer.device().name, renderer.device().driver, status.cellCount, view.width, view.height,
               options.cutoff, options.frames, views->size());
    printMeasurement(*measurement);
    fmt::print("memory       asset {:.1f} MiB, view {:.1f} MiB\n",
               static_cast<double>(status.deviceBytes) / (1 << 20),
               static_cast<double>(viewBytes) / (1 << 20));
  }
  nlohmann::ordered_json figures{{"input", options.input.string()},
                                 {"device", renderer.device().name},
                                 {"driver", renderer.device().driver},
                                 {"renderer", options.renderer},
                                 {"output", "linear colour, rgba16f"},
                                 {"cutoff", options.cutoff},
                                 {"width", view.width},
                                 {"height", view.height},
                                 {"layers", options.layers},
                                 {"frames", options.frames},
                                 {"cells", status.cellCount},
                                 {"assetBytes", status.deviceBytes},
                                 {"viewBytes", viewBytes}};
  figures.update(measurementAsJson(*measurement, *views));
  return options.figures.write(figures);
}

}  // namespace

void addBenchCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("bench", "Measure GPU time by pass over the views");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("INPUT", options->input, "A .froth file or a checkpoint")->required();
  command->add_option("--cameras", options->views.cameras, "The views (cameras.json)")->required();
  addViewOptions(*command, options->views);
  command->add_option("--renderer", options->renderer, "raster or walk")
      ->capture_default_str()
      ->check(CLI::IsMember({"raster", "walk"}));
  command->add_option("--cutoff", options->cutoff, "A ray ends below this transmittance")
      ->capture_default_str()
      ->check(numberBetween(0, 1));
  command->add_option("--frames", options->frames, "Measured frames, cycling through the views")
      ->capture_default_str()
      ->check(countBetween(100, 1000000));
  command
      ->add_option("--warmup", options->warmupSeconds, "Seconds of drawing before the first measured frame")
      ->capture_default_str()
      ->check(numberBetween(0, 3600));
  addLayersOption(*command, options->layers);
  command->add_option("--device", options->device, "Index or part of a name (`froth devices`)");
  addFiguresOption(*command, options->figures);
  command->callback([&tool, options] {
    tool.action = [&tool, options] { return runBench(*options, tool.progress.callback()); };
  });
}

}  // namespace froth
