#include "measure/bench/ray_bench.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/progress_printer.h"
#include "measure/gpu/gpu_camera.h"
#include "reference/camera/view_rays.h"
#include "shaders/foam/colour.h"

namespace froth {
namespace {

constexpr uint32_t kBlock = 8;                            // [pixels] edge of the blocks in which a shader casts rays
constexpr float kLightDirection[] = {0.3f, -0.8f, 0.5f};  // towards it, in world axes
constexpr float kAboveSurface = 0.01f;                    // of the distance: where rays from surfaces start

// Block by block, as a compute shader casts them.
std::vector<FrothGpuRay> cameraRays(const View& view) {
  const ViewRays rays(view);
  std::vector<FrothGpuRay> all;
  for (uint32_t y = 0; y < view.height; y += kBlock) {
    for (uint32_t x = 0; x < view.width; x += kBlock) {
      for (uint32_t i = 0; i < kBlock * kBlock; ++i) {
        const uint32_t column = x + i % kBlock, row = y + i / kBlock;
        if (column >= view.width || row >= view.height) continue;
        const std::optional<ViewRay> ray = rays.ofPixel(column, row);
        if (ray) all.push_back(gpuRayOf(view, *ray, std::numeric_limits<float>::infinity()));
      }
    }
  }
  return all;
}

// From where the rays were stopped, a hair above the surface. light: null for the mirrored direction.
std::vector<FrothGpuRay> secondRays(const std::vector<FrothGpuRay>& rays, const std::vector<FrothGpuHit>& hits,
                                    const float* light) {
  std::vector<FrothGpuRay> second;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!std::isfinite(hits[i].distance)) continue;
    const float* d = rays[i].direction;
    const float* n = hits[i].normal;
    const float facing = d[0] * n[0] + d[1] * n[1] + d[2] * n[2];
    const float side = facing < 0 ? 1.0f : -1.0f;
    FrothGpuRay ray{};
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = rays[i].origin[axis] + hits[i].distance * (d[axis] + side * kAboveSurface * n[axis]);
      ray.direction[axis] = light ? light[axis] : d[axis] - 2 * facing * n[axis];
    }
    ray.apex = light ? 0 : rays[i].apex + hits[i].distance;
    second.push_back(ray);
  }
  return second;
}

std::vector<FrothGpuRay> inBaseColours(std::vector<FrothGpuRay> rays) {
  for (FrothGpuRay& ray : rays) ray.flags = FROTH_RAY_BASE_COLOURS;
  return rays;
}

void addError(const std::vector<FrothGpuHit>& hits, const std::vector<FrothGpuHit>& expected, ColourError& error) {
  const auto coded = [](const FrothGpuHit& hit) {
    return foam::displayPremultiplied<float>({hit.colour[0], hit.colour[1], hit.colour[2]}, 1 - hit.transmittance);
  };
  for (size_t i = 0; i < hits.size(); ++i) {
    const glm::dvec3 difference = glm::abs(glm::dvec3(coded(hits[i])) - glm::dvec3(coded(expected[i])));
    error.squares += glm::dot(difference, difference);
    error.largest = std::max({error.largest, difference.x, difference.y, difference.z});
    error.values += 3;
  }
}

void addWork(const FrothWalkStatus& status, FrothWalkStatus& sum) {
  sum.rays += status.rays;
  sum.descents += status.descents;
  sum.cells += status.cells;
  sum.neighbours += status.neighbours;
  sum.cellsMet += status.cellsMet;
  sum.detailSites += status.detailSites;
}

class RayBench {
 public:
  RayBench(GpuRenderer& renderer, const RayBenchOptions& options, const Progress& progress)
      : renderer_(renderer), options_(options), progress_(progress) {}

  Status addView(const View& view) {
    const Result<FrothViewStatus> drawn = renderer_.draw(view, {});  // rays meet the levels that the view wants
    if (!drawn) return drawn.error();
    eye_ = eyeOf(view);
    const std::vector<FrothGpuRay> rays = cameraRays(view);
    std::vector<FrothGpuHit> hits;
    next_ = 0;
    if (Status done = add("camera, transmittance", rays, FROTH_RAY_TRANSMITTANCE); !done) return done;
    if (Status done = add("camera, closest", rays, FROTH_RAY_CLOSEST, &hits); !done) return done;
    if (Status done = addRadiance("camera", rays); !done) return done;
    const std::vector<FrothGpuRay> mirrored = secondRays(rays, hits, nullptr);
    if (Status done = addRadiance("mirrored", mirrored); !done) return done;
    return add("to a light, transmittance", secondRays(rays, hits, kLightDirection), FROTH_RAY_TRANSMITTANCE);
  }

  std::vector<RayFigures>& figures() { return figures_; }

 private:
  Status addRadiance(const std::string& from, const std::vector<FrothGpuRay>& rays) {
    std::vector<FrothGpuHit> seen, base;
    if (Status done = add(from + ", radiance", rays, FROTH_RAY_RADIANCE, &seen); !done) return done;
    if (Status done = add(from + ", base colours", inBaseColours(rays), FROTH_RAY_RADIANCE, &base); !done) return done;
    std::optional<ColourError>& error = figures_[next_ - 1].error;
    if (!error) error.emplace();
    addError(base, seen, *error);
    return {};
  }

  Status add(const std::string& kind, const std::vector<FrothGpuRay>& rays, FrothRayKind gpuKind,
             std::vector<FrothGpuHit>* hits = nullptr) {
    if (!report(progress_, kind, 0, 0)) return stoppedError();
    const RayTiming timing{eye_, gpuKind, options_.cutoff, options_.frames, hits != nullptr};
    Result<RayTimes> times = renderer_.timeRays(rays, timing);
    if (!times) return times.error();
    if (next_ == figures_.size()) figures_.push_back({kind, 0, {}, {}, {}});
    RayFigures& figures = figures_[next_++];
    figures.rays += rays.size();
    if (!rays.empty()) figures.viewTimes.push_back(std::move(times->milliseconds));
    addWork(times->status, figures.work);
    if (hits) *hits = std::move(times->hits);
    return {};
  }

  GpuRenderer& renderer_;
  const RayBenchOptions& options_;
  const Progress& progress_;
  glm::dvec3 eye_{0};
  size_t next_ = 0;
  std::vector<RayFigures> figures_;
};

std::string errorText(const std::optional<ColourError>& error) {
  return error ? fmt::format(" {:8.2f} {:9.4f}", error->psnr(), error->largest) : std::string();
}

struct WorkColumn {
  const char* name;
  uint64_t FrothWalkStatus::*sum;
};

constexpr WorkColumn kWorkColumns[] = {{"descents", &FrothWalkStatus::descents},
                                       {"cells", &FrothWalkStatus::cells},
                                       {"neighbours", &FrothWalkStatus::neighbours},
                                       {"cellsMet", &FrothWalkStatus::cellsMet},
                                       {"detailSites", &FrothWalkStatus::detailSites}};

double perRay(const RayFigures& figures, const WorkColumn& column) {
  return static_cast<double>(figures.work.*column.sum) / static_cast<double>(std::max<uint64_t>(figures.work.rays, 1));
}

}  // namespace

Percentiles timesOf(const RayFigures& figures) {
  Percentiles mean;
  const double share = 1.0 / static_cast<double>(std::max<size_t>(figures.viewTimes.size(), 1));
  for (const std::vector<double>& times : figures.viewTimes) {
    const Percentiles view = percentilesOf(times);
    mean.median += share * view.median;
    mean.p5 += share * view.p5;
    mean.p95 += share * view.p95;
  }
  return mean;
}

double ColourError::psnr() const { return 10 * std::log10(static_cast<double>(values) / squares); }

Result<std::vector<RayFigures>> benchRays(GpuRenderer& renderer, const std::vector<SelectedView>& views,
                                          const RayBenchOptions& options, const Progress& progress) {
  RayBench bench(renderer, options, progress);
  for (const SelectedView& view : views) {
    if (Status done = bench.addView(view.view); !done) return done.error();
  }
  return std::move(bench.figures());
}

void printRays(const std::vector<RayFigures>& figures, bool isCounting) {
  fmt::print("{:<26} {:>9} {:>9} {:>9} {:>11}", "rays [ms of a view]", "median", "p5", "p95", "rays");
  for (const WorkColumn& column : kWorkColumns) {
    if (isCounting) fmt::print(" {:>11}", column.name);
  }
  fmt::print(" {:>8} {:>9}\n", "PSNR", "largest");
  for (const RayFigures& kind : figures) {
    const Percentiles times = timesOf(kind);
    fmt::print("{:<26} {:9.3f} {:9.3f} {:9.3f} {:11}", kind.kind, times.median, times.p5, times.p95, kind.rays);
    for (const WorkColumn& column : kWorkColumns) {
      if (isCounting) fmt::print(" {:11.2f}", perRay(kind, column));
    }
    fmt::print("{}\n", errorText(kind.error));
  }
}

nlohmann::ordered_json raysAsJson(const std::vector<RayFigures>& figures, bool isCounting) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (const RayFigures& kind : figures) {
    const Percentiles times = timesOf(kind);
    nlohmann::ordered_json entry{
        {"kind", kind.kind}, {"rays", kind.rays}, {"median", times.median}, {"p5", times.p5}, {"p95", times.p95}};
    for (const WorkColumn& column : kWorkColumns) {
      if (isCounting) entry["perRay"][column.name] = perRay(kind, column);
    }
    if (kind.error) entry["error"] = {{"psnr", kind.error->psnr()}, {"largest", kind.error->largest}};
    result.push_back(std::move(entry));
  }
  return result;
}

}  // namespace froth
