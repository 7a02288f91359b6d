#include "reference/render/reference_state.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

#include "reference/camera/ray_map.h"

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

}  // namespace

Status checkRender(const View& view, const ReferenceOptions& options) {
  if (view.width == 0 || view.height == 0 || uint64_t{view.width} * view.height > kMaxPixels) {
    return makeError(ErrorKind::kUsage, "view '%s': size %u x %u; give 1 to 2^28 pixels", view.name.c_str(), view.width,
                     view.height);
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
  if (!(options.quantile > 0 && options.quantile <= 1)) {
    return makeError(ErrorKind::kUsage, "quantile: found %g; give a transmittance above 0 and at most 1",
                     options.quantile);
  }
  return {};
}

RenderedImages emptyImages(const View& view) {
  const size_t pixels = size_t{view.width} * view.height;
  RenderedImages images;
  images.colour = {view.width, view.height, 3, std::vector<float>(pixels * 3)};
  images.alpha = {view.width, view.height, 1, std::vector<float>(pixels)};
  images.distance = {view.width, view.height, 1, std::vector<float>(pixels, -1.0f)};
  images.normal = {view.width, view.height, 3, std::vector<float>(pixels * 3)};
  images.cells.resize(pixels, UINT32_MAX);
  images.quarters.resize(pixels, {-1, -1, -1, -1});
  images.quarterFoams.resize(pixels);
  return images;
}

Status renderRows(uint32_t rows, const Progress& progress, const std::function<void(uint32_t y)>& renderRow) {
  RowCounter counter(progress, rows);
  tbb::task_group_context context;
  tbb::parallel_for(
      tbb::blocked_range<uint32_t>(0, rows),
      [&](const tbb::blocked_range<uint32_t>& range) {
        for (uint32_t y = range.begin(); y < range.end(); ++y) {
          renderRow(y);
          if (!counter.finishRow()) {
            context.cancel_group_execution();
            return;
          }
        }
      },
      tbb::auto_partitioner(), context);
  if (counter.isStopped()) return stoppedOnRequest("render");
  return {};
}

}  // namespace froth
