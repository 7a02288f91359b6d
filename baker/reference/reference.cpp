#include "baker/reference/reference.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <limits>
#include <mutex>

#include "baker/camera/ray_map.h"
#include "baker/reference/ball_hierarchy.h"
#include "baker/reference/ray.h"
#include "baker/reference/view_cells.h"

namespace froth {
namespace {

constexpr uint64_t kMaxPixels = uint64_t{1} << 28;

// Counts rows from all threads, reports about a hundred times, one thread at a time.
class RowCounter {
 public:
  RowCounter(const Progress& progress, uint32_t rows)
      : progress_(progress), rows_(rows), stride_(std::max(rows / 100, 1u)) {}

  // False: stop.
  bool finishRow() {
    const uint32_t done = ++done_;
    if (done % stride_ == 0) {
      const std::lock_guard lock(mutex_);
      if (!isStopped_ && !report(progress_, "render", done, rows_)) isStopped_ = true;
    }
    return !isStopped_;
  }
  bool isStopped() const { return isStopped_; }

 private:
  const Progress& progress_;
  const uint32_t rows_, stride_;
  std::atomic<uint32_t> done_ = 0;
  std::atomic<bool> isStopped_ = false;
  std::mutex mutex_;
};

template <class Real>
class ImageRenderer {
 public:
  ImageRenderer(const BallHierarchy& hierarchy, const ViewCells<Real>& cells, const View& view,
                const ReferenceOptions& options)
      : hierarchy_(hierarchy),
        cells_(cells),
        view_(view),
        rays_(view),
        sceneDistance_(options.sceneDistance),
        settings_{Real(options.cutoff), Real(std::log(options.depthQuantile)),
                  Real(options.detailSharpness)} {
    const size_t pixels = size_t{view.width} * view.height;
    images_.colour = {view.width, view.height, 3, std::vector<float>(pixels * 3)};
    images_.alpha = {view.width, view.height, 1, std::vector<float>(pixels)};
    images_.depth = {view.width, view.height, 1, std::vector<float>(pixels, -1.0f)};
    images_.normal = {view.width, view.height, 3, std::vector<float>(pixels * 3)};
    images_.cells.resize(pixels, UINT32_MAX);
    sources_.resize(cells.cells.size());
    for (uint32_t cell = 0; cell < cells.rankOf.size(); ++cell) {
      if (cells.rankOf[cell] != ViewCells<Real>::kNotDrawn) sources_[cells.rankOf[cell]] = cell;
    }
  }

  Result<RenderedImages> render(const Progress& progress) {
    RowCounter counter(progress, view_.height);
    tbb::task_group_context context;
    tbb::parallel_for(
        tbb::blocked_range<uint32_t>(0, view_.height),
        [&](const tbb::blocked_range<uint32_t>& rows) {
          std::vector<BallHit<Real>> hits;
          for (uint32_t y = rows.begin(); y < rows.end(); ++y) {
            for (uint32_t x = 0; x < view_.width; ++x) renderPixel(x, y, hits);
            if (!counter.finishRow()) {
              context.cancel_group_execution();
              return;
            }
          }
        },
        tbb::auto_partitioner(), context);
    if (counter.isStopped()) return stoppedOnRequest("render");
    return std::move(images_);
  }

 private:
  void renderPixel(uint32_t x, uint32_t y, std::vector<BallHit<Real>>& hits) {
    const std::optional<ViewRay> exact = rays_.ofPixel(x, y);
    if (!exact) return;
    const PrimaryRay<Real> primary{exact->offset, exact->direction};
    const Real end = sceneDistance_ ? Real(*sceneDistance_->pixel(x, y)) : std::numeric_limits<Real>::infinity();
    hits.clear();
    hierarchy_.visitAlongRay(eyeOf(view_) + exact->offset, exact->direction, [&](uint32_t source) {
      BallHit<Real> hit{cells_.rankOf[source], 0, 0};
      if (hit.rank == ViewCells<Real>::kNotDrawn) return;
      const ViewCell<Real>& cell = cells_.cells[hit.rank];
      if (!foam::intersectBall(cell.centre - primary.offset, cell.radius, primary.direction, hit.tNear, hit.tFar)) return;
      hit.tFar = std::min(hit.tFar, end);
      if (hit.tNear < hit.tFar) hits.push_back(hit);
    });
    const RayResult<Real> ray = compositeHits(cells_, primary, settings_, hits);
    for (int c = 0; c < 3; ++c) {
      images_.colour.pixel(x, y)[c] = static_cast<float>(ray.colour[c]);
      images_.normal.pixel(x, y)[c] = static_cast<float>(ray.normal[c]);
    }
    *images_.alpha.pixel(x, y) = static_cast<float>(-std::expm1(ray.logTransmittance));
    *images_.depth.pixel(x, y) = static_cast<float>(ray.depth);
    if (ray.rank != UINT32_MAX) images_.cells[size_t{y} * view_.width + x] = sources_[ray.rank];
  }

  const BallHierarchy& hierarchy_;
  const ViewCells<Real>& cells_;
  const View& view_;
  const ViewRays rays_;
  const Image* const sceneDistance_;
  const RaySettings<Real> settings_;
  std::vector<uint32_t> sources_;  // [rank] the foam's cell
  RenderedImages images_;
};

}  // namespace

struct ReferenceRenderer::State {
  State(const Foam& source, const Progress& progress)
      : foam(source),
        visible(findVisibleCells(source)),
        cechPairs(findCechPairs(source.sites, source.radii, progress)),
        hierarchy(source.sites, source.radii, visible) {}

  template <class Real>
  Result<RenderedImages> render(const View& view, const ReferenceOptions& options,
                                const Progress& progress) const {
    if (cechPairs.offsets.empty()) return stoppedOnRequest("render");
    const ViewCells<Real> cells = prepareViewCells<Real>(foam, cechPairs, visible, view, options);
    return ImageRenderer<Real>(hierarchy, cells, view, options).render(progress);
  }

  const Foam& foam;
  const std::vector<uint32_t> visible;
  const CellGraph cechPairs;
  const BallHierarchy hierarchy;
};

ReferenceRenderer::ReferenceRenderer(const Foam& foam, const Progress& progress)
    : state_(std::make_unique<State>(foam, progress)) {}
ReferenceRenderer::~ReferenceRenderer() = default;

Result<RenderedImages> ReferenceRenderer::render(const View& view, const ReferenceOptions& options,
                                                 const Progress& progress) const {
  if (view.width == 0 || view.height == 0 || uint64_t{view.width} * view.height > kMaxPixels) {
    return makeError(ErrorKind::kUsage, "view '%s': size %u x %u; give 1 to 2^28 pixels", view.name.c_str(),
                     view.width, view.height);
  }
  if (view.lens.kind == LensKind::kRayMap &&
      !(view.lens.rays && view.lens.rays->width == view.width && view.lens.rays->height == view.height)) {
    return makeError(ErrorKind::kUsage, "view '%s': a ray map without one ray per pixel; read its file",
                     view.name.c_str());
  }
  if (options.sceneDistance &&
      !(options.sceneDistance->width == view.width && options.sceneDistance->height == view.height)) {
    return makeError(ErrorKind::kUsage, "view '%s': scene distances of %u x %u pixels for %u x %u", view.name.c_str(),
                     options.sceneDistance->width, options.sceneDistance->height, view.width, view.height);
  }
  if (!(options.depthQuantile > 0 && options.depthQuantile <= 1)) {
    return makeError(ErrorKind::kUsage,
                     "depth quantile: found %g; give a transmittance above 0 and at most 1",
                     options.depthQuantile);
  }
  return options.precision == Precision::kFloat ? state_->render<float>(view, options, progress)
                                                : state_->render<double>(view, options, progress);
}

}  // namespace froth
