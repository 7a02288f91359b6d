#include "measure/sweep/measure.h"

#include <algorithm>
#include <cmath>
#include <future>

#include "base/progress_printer.h"

namespace froth {
namespace {

View shrink(const View& view, double pixelSize) {
  if (pixelSize == 1) return view;
  const auto side = [&](uint32_t pixels) {
    return std::max(1u, static_cast<uint32_t>(std::lround(pixels / pixelSize)));
  };
  return resizeView(view, side(view.width), side(view.height));
}

Status describeAsset(const Bench& bench, PlannedPoint& planned) {
  const Result<BakeRecord> record = bench.bakes.recordOf(planned.config);
  if (!record) return record.error();
  planned.point.bakeSeconds = record->seconds;
  const std::filesystem::path asset = bench.bakes.assetOf(planned.config);
  std::error_code error;
  planned.point.diskBytes = std::filesystem::file_size(asset, error);
  if (error) return makeError(ErrorKind::kIo, "%s: %s", asset.c_str(), error.message().c_str());
  return {};
}

Status keepErrors(const Bench& bench, Result<PointErrors> errors, PlannedPoint& planned) {
  if (!errors) return errors.error();
  planned.point.errors = errors->errors;
  planned.point.photoErrors = errors->photoErrors;
  planned.point.wholeErrors = errors->wholeErrors;
  planned.point.views = std::move(errors->views);
  planned.hasErrors = true;
  return bench.log.append(planned.point);
}

// Images are compared while the next are drawn.
Status measureErrors(const Bench& bench, const std::vector<PlannedPoint*>& points, const Progress& progress) {
  std::future<Result<PointErrors>> compared;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!report(progress, "errors", i, points.size())) return stoppedError();
    Result<std::vector<RenderedImages>> images = bench.renderer.render(drawOf(bench, points[i]->config), {});
    if (!images) return images.error();
    if (Status described = describeAsset(bench, *points[i]); !described) return described;
    if (i > 0) {
      if (Status kept = keepErrors(bench, compared.get(), *points[i - 1]); !kept) return kept;
    }
    compared = std::async(std::launch::async, [&references = bench.references, taken = std::move(*images)]() mutable {
      return references.compare(std::move(taken));
    });
  }
  return points.empty() ? Status() : keepErrors(bench, compared.get(), *points.back());
}

Status measureTimes(const Bench& bench, const std::vector<PlannedPoint*>& points, const Progress& progress) {
  std::vector<Draw> draws;
  for (const PlannedPoint* planned : points) {
    draws.push_back(drawOf(bench, planned->config));
    draws.back().options.isLinear = true;  // as a game draws
  }
  const Result<std::vector<DrawTimes>> times = bench.renderer.time(draws, bench.rounds, progress);
  if (!times) return times.error();
  for (size_t i = 0; i < points.size(); ++i) {
    ReportPoint& point = points[i]->point;
    point.total = (*times)[i].total;
    point.passes = (*times)[i].passes;
    point.residentBytes = (*times)[i].residentBytes;
    point.drawnBytes = (*times)[i].drawn.bytes;
    point.drawnCells = (*times)[i].drawn.liveCells;
    point.viewBytes = (*times)[i].viewBytes;
    points[i]->hasTimes = true;
    if (Status logged = bench.log.append(point); !logged) return logged;
  }
  return {};
}

}  // namespace

Draw drawOf(const Bench& bench, const ReportConfig& config) {
  Draw draw;
  draw.asset = bench.bakes.assetOf(config);
  draw.layers = config.layers;
  draw.options.method = config.method;
  draw.options.cutoff = config.cutoff;
  draw.options.maxSteps = config.maxSteps;
  draw.options.readsNormal = false;
  draw.streaming = config.streaming;
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
  if (Status baked = bench.bakes.bake(configs, progress); !baked) return baked;
  if (Status measured = measureErrors(bench, unseen, progress); !measured) return measured;
  return measureTimes(bench, untimed, progress);
}

void takeOver(const std::vector<ReportPoint>& found, PointList& points) {
  for (PlannedPoint& planned : points.all()) {
    const auto old = std::find_if(found.begin(), found.end(),
                                  [&](const ReportPoint& point) { return point.id == planned.point.id; });
    if (old == found.end()) continue;
    planned.point = *old;
    planned.hasErrors = true;
    planned.hasTimes = old->total.median > 0;
  }
}

}  // namespace froth
