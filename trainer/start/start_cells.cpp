#include "trainer/start/start_cells.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "reference/camera/view_points.h"
#include "reference/camera/view_rays.h"
#include "trainer/start/nearest_sites.h"
#include "trainer/start/spread_points.h"
#include "trainer/start/start_streams.h"

namespace froth {
namespace {

constexpr double kReach = 1000;           // points further out are outliers; cameras see theirs at 4
constexpr double kHeightShare = 0.05;     // of an image that a radius covers at most
constexpr double kNear = 0.4, kFar = 40;  // depths of random cells: a tenth and ten times the median distance
constexpr uint32_t kTries = 64;           // for a pixel of the object, and for a depth in the visual hull
constexpr double kObject = 0.5;           // alpha from which a pixel shows the object
constexpr double kMissing = 0.1;          // of the views may not show it in the hull: masks are not exact

// The largest that a ball at a place may be in a view.
double mostRadiusIn(const View& view, const glm::dvec3& place) {
  return kHeightShare * view.height / view.fy * glm::distance(eyeOf(view), place);
}

void seeFrom(const View& view, StartCell& cell) {
  const glm::dvec3 offset = eyeOf(view) - cell.position;
  const double distance = glm::length(offset);
  if (!(distance > 0)) return;
  cell.towards += offset / distance;
  if (view.lens.kind == LensKind::kRayMap || view.lens.kind == LensKind::kOrthographic) return;
  cell.mostRadius = std::min(cell.mostRadius, mostRadiusIn(view, cell.position));
}

std::vector<View> trainingViews(const StartScene& scene) {
  std::vector<View> views;
  for (const uint32_t index : scene.training) views.push_back(normalised(scene.capture.views[index].view, scene.frame));
  return views;
}

// Of the training views that have a place in their images, the one in which a ball there looks largest.
class NearestViews {
 public:
  explicit NearestViews(const StartScene& scene) : views_(trainingViews(scene)) {
    for (const View& view : views_) points_.emplace_back(view);
  }

  // Null: none has it.
  const View* of(const glm::dvec3& place) const {
    const View* nearest = nullptr;
    double least = HUGE_VAL;
    for (size_t i = 0; i < views_.size(); ++i) {
      const double radius = mostRadiusIn(views_[i], place);
      if (!(radius < least) || !points_[i].of(place)) continue;
      least = radius;
      nearest = &views_[i];
    }
    return nearest;
  }

 private:
  std::vector<View> views_;  // filled before points_ refer to it
  std::vector<ViewPoints> points_;
};

// Premultiplied pixel of a photo; `pixel` in pixels of its view.
glm::dvec4 pixelOf(const Photo& photo, const glm::dvec2& pixel, const View& view) {
  const auto x = std::min(static_cast<uint32_t>(pixel.x * photo.view.width / view.width), photo.view.width - 1);
  const auto y = std::min(static_cast<uint32_t>(pixel.y * photo.view.height / view.height), photo.view.height - 1);
  const uint8_t* rgba = &photo.rgba[(size_t{y} * photo.view.width + x) * 4];
  return glm::dvec4(rgba[0], rgba[1], rgba[2], rgba[3]) / 255.0;
}

class FrustumSampler {
 public:
  explicit FrustumSampler(const StartScene& scene)
      : scene_(scene),
        views_(trainingViews(scene)),
        pixels_(startRandom(scene.seed, StartStream::kPixel)),
        depths_(startRandom(scene.seed, StartStream::kDepth)) {
    for (const View& view : views_) {
      rays_.emplace_back(view);
      points_.emplace_back(view);
    }
  }

  StartCell cellAt(uint32_t index) const {
    StartCell cell;
    const std::optional<Aim> aim = aimAt(index, cell);
    if (!aim) return cell;
    const View& view = views_[aim->view];
    for (uint32_t attempt = 0; attempt < kTries; ++attempt) {
      const double share = depths_.uniform(uint64_t{index} * kTries + attempt);
      cell.position = eyeOf(view) + aim->ray.offset + kNear * std::pow(kFar / kNear, share) * aim->ray.direction;
      if (scene_.photos.empty() || isInHull(cell.position)) break;
    }
    seeFrom(view, cell);
    return cell;
  }

 private:
  struct Aim {
    uint32_t view;
    ViewRay ray;
  };

  // A random pixel that has a ray, and shows the object where there is alpha. None in all tries: an empty photo.
  std::optional<Aim> aimAt(uint32_t index, StartCell& cell) const {
    for (uint32_t attempt = 0; attempt < kTries; ++attempt) {
      const uint64_t first = 3 * (uint64_t{index} * kTries + attempt);
      const auto view = static_cast<uint32_t>(pixels_.uniform(first) * static_cast<double>(views_.size()));
      const glm::dvec2 pixel(pixels_.uniform(first + 1) * views_[view].width,
                             pixels_.uniform(first + 2) * views_[view].height);
      const std::optional<ViewRay> ray = rays_[view].at(pixel.x, pixel.y);
      if (!ray) continue;
      if (scene_.photos.empty()) return Aim{view, *ray};
      const glm::dvec4 shown = pixelOf(scene_.photos[view], pixel, views_[view]);
      if (shown.w < kObject) continue;
      cell.colour = glm::dvec3(shown) / shown.w;
      return Aim{view, *ray};
    }
    return std::nullopt;
  }

  // Views that do not frame a place say nothing.
  bool isInHull(const glm::dvec3& place) const {
    const double most = kMissing * static_cast<double>(views_.size());
    uint32_t missing = 0;
    for (size_t i = 0; i < views_.size() && missing <= most; ++i) {
      const std::optional<glm::dvec2> pixel = points_[i].of(place);
      missing += pixel && pixelOf(scene_.photos[i], *pixel, views_[i]).w < kObject;
    }
    return missing <= most;
  }

  const StartScene& scene_;
  std::vector<View> views_;  // filled before rays_ and points_ refer to it
  std::vector<ViewRays> rays_;
  std::vector<ViewPoints> points_;
  CounterRandom pixels_, depths_;
};

}  // namespace

std::vector<StartCell> cellsOfPoints(const StartScene& scene) {
  const Capture& capture = scene.capture;
  std::vector<glm::dvec3> positions;
  for (const CapturedPoint& point : capture.points) positions.push_back(normalised(point.position, scene.frame));
  std::vector<bool> isTraining(capture.views.size());
  for (const uint32_t index : scene.training) isTraining[index] = true;
  std::vector<View> views;
  for (const CapturedView& view : capture.views) views.push_back(normalised(view.view, scene.frame));

  const NearestViews nearest(scene);
  std::vector<StartCell> cells;
  for (const uint32_t index : spreadOrder(positions, kReach, scene.seed)) {
    const CapturedPoint& point = capture.points[index];
    StartCell cell;
    cell.position = positions[index];
    cell.colour = glm::dvec3(point.colour[0], point.colour[1], point.colour[2]) / 255.0;
    bool isSeen = point.observerCount == 0;
    const View* view = isSeen ? nearest.of(cell.position) : nullptr;
    if (view != nullptr) seeFrom(*view, cell);
    for (uint32_t i = 0; i < point.observerCount; ++i) {
      const uint32_t observer = capture.observers[point.firstObserver + i];
      if (!isTraining[observer]) continue;
      seeFrom(views[observer], cell);
      isSeen = true;
    }
    if (isSeen) cells.push_back(cell);
  }
  return cells;
}

std::vector<StartCell> mixCells(const std::vector<StartCell>& points, uint32_t count, uint64_t seed) {
  const CounterRandom random = startRandom(seed, StartStream::kMixture);
  std::vector<glm::vec3> sites;
  for (const StartCell& point : points) sites.emplace_back(point.position);
  const std::vector<float> radii(sites.size(), 0.0f);
  std::vector<uint32_t> members(sites.size());
  for (uint32_t i = 0; i < members.size(); ++i) members[i] = i;
  const SiteTree tree(sites, radii, std::move(members));
  std::vector<StartCell> cells(count);
  tbb::parallel_for(uint32_t{0}, count, [&](uint32_t i) {
    const uint64_t first = uint64_t{i} * (kMixed + 1);
    const auto base = static_cast<uint32_t>(random.uniform(first) * static_cast<double>(points.size()));
    StartCell& cell = cells[i];
    cell.position = cell.colour = glm::dvec3(0);
    double sum = 0;
    uint64_t draw = first;
    for (const NearSite& near : findNearestSites(tree, sites, points[base].position, kMixed)) {
      const double weight = -std::log(1 - random.uniform(++draw));  // normalised: uniform among all mixtures
      const StartCell& point = points[near.site];
      cell.position += weight * point.position;
      cell.colour += weight * point.colour;
      cell.towards += weight * point.towards;
      sum += weight;
    }
    cell.position /= sum;
    cell.colour /= sum;
    cell.mostRadius = points[base].mostRadius;
  });
  return cells;
}

void limitRadii(const StartScene& scene, std::vector<StartCell>& cells) {
  const NearestViews nearest(scene);
  tbb::parallel_for(size_t{0}, cells.size(), [&](size_t i) {
    StartCell& cell = cells[i];
    const View* view = nearest.of(cell.position);
    if (view != nullptr) cell.mostRadius = std::min(cell.mostRadius, mostRadiusIn(*view, cell.position));
  });
}

std::vector<StartCell> cellsInFrusta(const StartScene& scene, uint32_t count) {
  const FrustumSampler sampler(scene);
  std::vector<StartCell> cells(count);
  tbb::parallel_for(uint32_t{0}, count, [&](uint32_t i) { cells[i] = sampler.cellAt(i); });
  return cells;
}

}  // namespace froth
