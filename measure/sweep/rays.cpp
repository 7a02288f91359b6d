#include "measure/sweep/rays.h"

#include <algorithm>
#include <utility>

#include "host/ray_preparation.h"
#include "measure/bench/ray_bench.h"

namespace froth {
namespace {

RayCost costOf(const RayFigures& figures, const std::string& prepared, uint64_t residentBytes) {
  const Percentiles times = timesOf(figures);
  RayCost cost{figures.kind, prepared, {times.median, times.p5, times.p95}, figures.rays, residentBytes, {}, {}};
  if (figures.error) {
    cost.psnr = figures.error->psnr();
    cost.maxError = figures.error->largest;
  }
  return cost;
}

}  // namespace

Result<std::vector<RayCost>> rayCosts(const Bench& bench, GpuDeviceOptions device, const Progress& progress) {
  const ReportConfig config = defaultConfig();
  const Draw draw = drawOf(bench, config);
  AssetInput input;
  input.path = draw.asset;
  const auto frames = std::max(5u, bench.rounds.frames / static_cast<uint32_t>(bench.views.size()));
  device.castsRays = true;
  std::vector<RayCost> costs;
  std::vector<std::pair<std::string, FrothRayPreparation>> forms(kRayPreparations.begin(), kRayPreparations.end());
  std::ranges::sort(forms, {}, [](const auto& form) { return form.second; });  // from the least on
  for (const auto& [name, prepared] : forms) {
    device.prepareRays = prepared;
    const Result<std::unique_ptr<GpuRenderer>> renderer = GpuRenderer::create(device);
    if (!renderer) return renderer.error();
    if (Status loaded = (*renderer)->load(input, progress); !loaded) return loaded.error();
    const Result<std::vector<RayFigures>> figures =
        benchRays(**renderer, bench.views, {draw.options.cutoff, frames}, progress);
    if (!figures) return figures.error();
    const uint64_t bytes = (*renderer)->assetStatus().deviceBytes;
    for (const RayFigures& kind : *figures) costs.push_back(costOf(kind, name, bytes));
  }
  return costs;
}

}  // namespace froth
