#include "baker/tool/report/measure.h"

#include <algorithm>
#include <cmath>

#include "baker/tool/progress_printer.h"

namespace froth {
namespace {

View shrink(const View& view, double pixelSize) {
  if (pixelSize == 1) return view;
  const auto side = [&](uint32_t pixels) { return std::max(1u, static_cast<uint32_t>(std::lround(pixels / pixelSize))); };
  return resizeView(view, side(view.width), side(view.height));
}

Status measureErrors(const Bench& bench, PlannedPoint& planned, const Progress& progress) {
  Result<std::vector<RenderedImages>> images = bench.drawer.render(drawOf(bench, planned.config), progress);
  if (!images) return images.error();
  Result<PointErrors> errors = bench.truth.compare(std::move(*images));
  if (!errors) return errors.error();
  ReportPoint& point = planned.point;
  point.errors = errors->errors;
  point.photoErrors = errors->photoErrors;
  point.views = std::move(errors->views);
  const Result<BakeRecord> record = bench.workshop.recordOf(planned.config);
  if (!record) return record.error();
  point.bakeSeconds = record->seconds;
  std::error_code error;
  point.diskBytes = std::filesystem::file_size(bench.workshop.assetOf(planned.config), error);
  if (error) return makeError(ErrorKind::kIo, "%s: %s", bench.workshop.assetOf(planned.config).c_str(), error.message().c_str());
  planned.hasErrors = true;
  return bench.log.append(point);
}

Status measureTimes(const Bench& bench, const std::vector<PlannedPoint*>& points, const Progress& progress) {
  std::vector<Draw> draws;
  for (const PlannedPoint* planned : points) {
    draws.push_back(drawOf(bench, planned->config));
    draws.back().options.isLinear = true;  // as a game draws
  }
  const Result<std::vector<DrawTimes>> times = bench.drawer.time(draws, bench.rounds, progress);
  if (!times) return times.error();
  for (size_t i = 0; i < points.size(); ++i) {
    ReportPoint& point = points[i]->point;
    point.total = (*times)[i].total;
    point.passes = (*times)[i].passes;
    point.residentBytes = (*times)[i].residentBytes;
    points[i]->hasTimes = true;
    if (Status logged = bench.log.append(point); !logged) return logged;
  }
  return {};
}

}  // namespace

Draw drawOf(const Bench& bench, const ReportConfig& config) {
  Draw draw;
  draw.asset = bench.workshop.assetOf(config);
  draw.layers = config.layers;
  draw.options.method = config.method;
  draw.options.cutoff = config.cutoff;
  draw.options.maxSteps = config.maxSteps;
  for (const SelectedView& view : bench.views) draw.views.push_back(shrink(view.view, config.pixelSize));
  return draw;
}

Status measurePoints(const Bench& bench, std::vector<PlannedPoint*> points, const Progress& progress) {
  // Those of one asset follow each other.
  std::stable_sort(points.begin(), points.end(), [](const PlannedPoint* a, const PlannedPoint* b) {
    return encodingKey(a->config) < encodingKey(b->config);
  });
  std::vector<PlannedPoint*> unseen, untimed;
  for (PlannedPoint* planned : points) {
    if (!planned->hasErrors) unseen.push_back(planned);
    if (planned->isTimed && !planned->hasTimes) untimed.push_back(planned);
  }
  std::vector<ReportConfig> configs;
  for (const PlannedPoint* planned : points) {
    if (!planned->hasErrors || (planned->isTimed && !planned->hasTimes)) configs.push_back(planned->config);
  }
  if (Status baked = bench.workshop.bake(configs, progress); !baked) return baked;
  for (size_t i = 0; i < unseen.size(); ++i) {
    if (!report(progress, "errors", i, unseen.size())) return stoppedError();
    if (Status measured = measureErrors(bench, *unseen[i], {}); !measured) return measured;
  }
  return measureTimes(bench, untimed, progress);
}

void takeOver(const std::vector<ReportPoint>& found, PointList& points) {
  for (PlannedPoint& planned : points.all()) {
    const auto old = std::find_if(found.begin(), found.end(), [&](const ReportPoint& point) { return point.id == planned.point.id; });
    if (old == found.end()) continue;
    planned.point = *old;
    planned.hasErrors = true;
    planned.hasTimes = old->total.median > 0;
  }
}

}  // namespace froth
