#include "trainer/start/cover_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include <tbb/parallel_for.h>

#include "foam/site_tree.h"
#include "reference/camera/view_rays.h"

namespace froth {
namespace {

constexpr uint32_t kRows = 36;        // of samples over the height of an image: less than a ball's radius apart
constexpr double kBallShare = 0.08;   // of an image that a ball's radius covers
constexpr double kNearRatio = 4;      // of radii: nearer cells are not drawn (docs/FOAM.md "Near cells")
constexpr uint8_t kShownAlpha = 128;  // alpha from which a pixel shows the object
constexpr double kUnknownDepth = 8;   // where a view shows no cell: twice the median distance

struct Ball {
  glm::dvec3 centre;
  double radius;
};

// The balls of cells, and those that cover gaps: a tree finds the first, and the second are few.
class Balls {
 public:
  Balls(std::span<const StartCell> cells, std::span<const float> radii)
      : sites_(sitesOf(cells)), tree_(sites_, radii, placesOf(cells)) {
    for (size_t i = 0; i < cells.size(); ++i) balls_.push_back({cells[i].position, radii[i]});
  }

  void add(const Ball& ball) { balls_.push_back(ball); }

  // Visits those that the ray may meet.
  template <class Visit>
  void searchRay(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const {
    tree_.searchRay(origin, direction, [&](uint32_t i) { visit(balls_[i]); });
    for (size_t i = sites_.size(); i < balls_.size(); ++i) visit(balls_[i]);
  }

 private:
  static std::vector<glm::vec3> sitesOf(std::span<const StartCell> cells) {
    std::vector<glm::vec3> sites;
    for (const StartCell& cell : cells) sites.emplace_back(cell.position);
    return sites;
  }
  static std::vector<uint32_t> placesOf(std::span<const StartCell> cells) {
    std::vector<uint32_t> places(cells.size());
    std::iota(places.begin(), places.end(), 0u);
    return places;
  }

  std::vector<glm::vec3> sites_;
  SiteTree tree_;
  std::vector<Ball> balls_;
};

// Distance along a ray to the middle of its chord; none where it misses the ball, or the ball is not drawn.
std::optional<double> depthOf(const Ball& ball, const glm::dvec3& origin, const glm::dvec3& direction) {
  const glm::dvec3 offset = ball.centre - origin;
  const double along = glm::dot(offset, direction), squared = glm::dot(offset, offset);
  const bool isMet = along > 0 && squared - along * along < ball.radius * ball.radius;
  const bool isNear = squared < kNearRatio * kNearRatio * ball.radius * ball.radius;
  return isMet && !isNear ? std::optional(along) : std::nullopt;
}

// The rays of a view on a lattice of samples, and how deep its cells lie there.
class SampledView {
 public:
  SampledView(const View& view, const Photo& photo, const Balls& balls)
      : view_(view), columns_(std::max(1u, kRows * view.width / view.height)), samples_(columns_ * kRows) {
    const ViewRays rays(view);
    tbb::parallel_for(size_t{0}, samples_.size(), [&](size_t i) { sample(rays, photo, balls, i); });
  }

  // Covers what is uncovered, in the order of the samples.
  void cover(std::vector<StartCell>& cells, Balls& balls, uint32_t most) {
    const std::vector<double> depths = depthsAround();
    for (size_t i = 0; i < samples_.size() && cells.size() < most; ++i) {
      const Sample& sample = samples_[i];
      if (!sample.isWanted || sample.depth > 0) continue;
      const double radius = kBallShare * view_.height / view_.fy * depths[i];
      StartCell cell;
      cell.position = sample.ray.offset + eyeOf(view_) + depths[i] * sample.ray.direction;
      cell.towards = -sample.ray.direction;
      cell.colour = sample.colour;
      cell.mostRadius = radius;
      cells.push_back(cell);
      const Ball ball{cell.position, radius};
      balls.add(ball);
      for (Sample& other : samples_) meet(other, ball);
    }
  }

 private:
  struct Sample {
    ViewRay ray;
    glm::dvec3 colour;
    double depth = 0;       // of the farthest cell on the ray; 0: none
    bool isWanted = false;  // has a ray, and its pixel counts
  };

  void meet(Sample& sample, const Ball& ball) const {
    const std::optional<double> depth = depthOf(ball, eyeOf(view_) + sample.ray.offset, sample.ray.direction);
    if (depth) sample.depth = std::max(sample.depth, *depth);
  }

  void sample(const ViewRays& rays, const Photo& photo, const Balls& balls, size_t index) {
    const double x = (double(index % columns_) + 0.5) / columns_, y = (double(index / columns_) + 0.5) / kRows;
    const std::optional<ViewRay> ray = rays.at(x * view_.width, y * view_.height);
    const size_t pixel = size_t(y * photo.view.height) * photo.view.width + size_t(x * photo.view.width);
    const uint8_t* rgba = &photo.rgba[pixel * 4];
    Sample& sample = samples_[index];
    sample.isWanted = ray && rgba[3] >= kShownAlpha && (photo.counted.empty() || photo.counted[pixel] != 0);
    if (!sample.isWanted) return;
    sample.ray = *ray;
    sample.colour = glm::dvec3(rgba[0], rgba[1], rgba[2]) / double(rgba[3]);
    balls.searchRay(eyeOf(view_) + ray->offset, ray->direction, [&](const Ball& ball) { meet(sample, ball); });
  }

  // The median over eight directions of the first sample there that shows a cell.
  double depthAround(size_t index) const {
    std::vector<double> depths;
    const int column = int(index % columns_), row = int(index / columns_);
    for (int turn = 0; turn < 9; ++turn) {
      const int dx = turn % 3 - 1, dy = turn / 3 - 1;
      if (dx == 0 && dy == 0) continue;
      for (int x = column, y = row; x >= 0 && x < int(columns_) && y >= 0 && y < int(kRows); x += dx, y += dy) {
        const double depth = samples_[size_t(y) * columns_ + size_t(x)].depth;
        if (!(depth > 0)) continue;
        depths.push_back(depth);
        break;
      }
    }
    if (depths.empty()) return kUnknownDepth;
    std::nth_element(depths.begin(), depths.begin() + std::ptrdiff_t(depths.size() / 2), depths.end());
    return depths[depths.size() / 2];
  }

  // Of all samples, before any is covered: what covers a gap does not tell how deep the gap is.
  std::vector<double> depthsAround() const {
    std::vector<double> depths(samples_.size());
    for (size_t i = 0; i < samples_.size(); ++i) depths[i] = samples_[i].depth > 0 ? samples_[i].depth : depthAround(i);
    return depths;
  }

  const View& view_;
  uint32_t columns_;
  std::vector<Sample> samples_;
};

}  // namespace

std::vector<StartCell> cellsInGaps(const StartScene& scene, std::span<const StartCell> cells,
                                   std::span<const float> radii, uint32_t most) {
  Balls balls(cells, radii);
  std::vector<StartCell> found;
  for (size_t i = 0; i < scene.photos.size() && found.size() < most; ++i) {
    const View view = normalised(scene.capture.views[scene.training[i]].view, scene.frame);
    SampledView(view, scene.photos[i], balls).cover(found, balls, most);
  }
  return found;
}

}  // namespace froth
