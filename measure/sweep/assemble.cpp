#include "measure/sweep/assemble.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/version.h"

namespace froth {
namespace {

// What a default preset has to keep [dB against the reference, in the worst view].
constexpr double kLeastWorstView = 42;
constexpr double kMostBytesPerCell = 80;  // of the input's cells

double worstViewOf(const ReportPoint& point) {
  double worst = point.errors.psnr;
  for (const ViewErrors& view : point.views) worst = std::min(worst, view.errors.psnr);
  return worst;
}

// Drawn as by default, with everything that the default can do.
bool isWholeAsset(const ReportConfig& config) {
  ReportConfig drawn = defaultConfig();
  drawn.knobs = config.knobs;
  drawn.detailsKept = config.detailsKept;
  return configKey(drawn) == configKey(config);
}

std::string describe(const ReportPoint& point, uint32_t cells) {
  return fmt::format("{:.1f} bytes per cell, worst view {:.2f} dB, mean {:.2f} dB, FLIP {:.4f}, {:.3f} ms",
                     static_cast<double>(point.diskBytes) / cells, worstViewOf(point), point.errors.psnr,
                     point.errors.flip, point.total.median);
}

// Of assets within the size bound: the smallest whose worst view is good enough, or else the one with the best worst
// view.
void choosePreset(const PointList& points, Report& report) {
  const ReportPoint& base = points.all().front().point;
  const ReportPoint *smallest = nullptr, *best = nullptr;
  for (const PlannedPoint& planned : points.all()) {
    const ReportPoint& point = planned.point;
    if (!planned.isTimed || !isWholeAsset(planned.config)) continue;
    if (static_cast<double>(point.diskBytes) > kMostBytesPerCell * report.cells) continue;
    if (!best || worstViewOf(point) > worstViewOf(*best)) best = &point;
    if (worstViewOf(point) >= kLeastWorstView && (!smallest || point.diskBytes < smallest->diskBytes)) {
      smallest = &point;
    }
  }
  const ReportPoint& chosen = smallest ? *smallest : best ? *best : base;
  report.chosen = chosen.id;
  report.choice = fmt::format(
      "Of assets of at most {} bytes per cell, the smallest whose worst view keeps {} dB against the reference{}: {}, "
      "{}.",
      kMostBytesPerCell, kLeastWorstView, smallest ? "" : " (none does; so the one with the best worst view)",
      chosen.id == base.id ? "the default itself" : chosen.id, describe(chosen, report.cells));
  if (chosen.id != base.id) report.choice += fmt::format(" The default has {}.", describe(base, report.cells));
}

Status addPictures(const PlannedPoint& planned, const Bench& bench, Report& report) {
  const Result<std::vector<RenderedImages>> images = bench.renderer.render(drawOf(bench, planned.config), {});
  if (!images) return images.error();
  for (size_t i = 0; i < images->size(); ++i) {
    const ViewErrors& errors = planned.point.views[i];
    const Result<std::vector<ReportImage>> pictures =
        picturesOfError(fmt::format("View {}", errors.view), bench.references.exact(i), (*images)[i].colour,
                        errors.worstX, errors.worstY);
    if (!pictures) return pictures.error();
    report.images.insert(report.images.end(), pictures->begin(), pictures->end());
  }
  return {};
}

}  // namespace

void describeRun(const RunDescription& run, const Foam& foam, const Bench& bench, Report& report) {
  report.scene = run.title;
  report.input = run.input;
  report.credit = run.credit;
  report.device = bench.renderer.device();
  report.driver = bench.renderer.driver();
  report.version = kVersion;
  report.command = run.command;
  report.seed = bench.rounds.seed;
  report.width = bench.views[0].view.width;
  report.height = bench.views[0].view.height;
  report.frames = bench.rounds.frames;
  for (const SelectedView& view : bench.views) report.views.push_back(static_cast<uint32_t>(view.index));
  report.cells = foam.cellCount;
  report.detailCount = foam.detailCount;
  report.lobeCount = foam.lobeCount;
  report.isLinearTime = !run.isCpu;
  report.notes = {
      "Errors are of all channels in float, display-coded; times are of linear half-float colour alone, as a game "
      "draws.",
      "Shading precision: the runtime computes in 32-bit float; it has no setting for less.",
      "Tile size: fixed, lists for 32 x 32 pixels, drawn 8 x 8 at a time; another size needs other shaders.",
      "Levels of detail are measured of an asset that has them (froth bake --lod): give it as the input."};
  if (!run.hasFoam) {
    report.notes.push_back(
        "The input is an asset: errors are against the foam that it holds, and its encoding is not turned. Give the "
        "checkpoint for both.");
  }
  if (run.isCpu) {
    report.notes.push_back("Times are of the CPU reference renderer; walks, memory and costs of features need a GPU.");
  }
}

Status fillReport(const PointList& points, const Bench& bench, bool hasImages, Report& report) {
  std::vector<ReportPoint> timed;
  for (const PlannedPoint& planned : points.all()) {
    report.points.push_back(planned.point);
    if (planned.isTimed) timed.push_back(planned.point);
  }
  const std::string renderer = report.points.front().renderer;
  report.frontOverTime = paretoFront(timed, renderer, Cost::kTime);
  report.frontOverBytes = paretoFront(timed, renderer, Cost::kDiskBytes);
  choosePreset(points, report);
  if (!hasImages) return {};
  return addPictures(points.all().front(), bench, report);
}

Status writeReport(const std::filesystem::path& folder, const Report& report) {
  const auto write = [&](const char* name, const std::string& text) {
    return writeFileAtomically(folder / name, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  };
  const std::string json = reportAsJson(report).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (Status written = write("report.json", json); !written) return written;
  if (Status written = write("report.csv", reportAsCsv(report)); !written) return written;
  return write("report.html", reportAsHtml(report));
}

}  // namespace froth
