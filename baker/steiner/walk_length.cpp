#include "baker/steiner/walk_length.h"

#include <time.h>

#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "base/counter_random.h"
#include "reference/camera/view_rays.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"
#include "shaders/foam/next_cell.h"

namespace froth {
namespace {

constexpr float kLogCutoff = -6.9077553f;  // ln 1e-3
constexpr uint32_t kNoCell = 0xffffffff;
constexpr size_t kRaysPerBlock = 256;

class Walker {
 public:
  Walker(const WalkCells& cells, const CellGraph& graph) : cells_(cells), graph_(graph) {}

  // The cell that holds a point: down the powers from neighbour to neighbour; there is no local minimum.
  uint32_t locate(const glm::dvec3& point, uint32_t start) const {
    uint32_t cell = start;
    double least = powerOf(cell, point);
    for (uint32_t previous = kNoCell; cell != previous;) {
      previous = cell;
      for (uint32_t i = graph_.offsets[previous]; i < graph_.offsets[previous + 1]; ++i) {
        const double power = powerOf(graph_.neighbours[i], point);
        if (power < least) least = power, cell = graph_.neighbours[i];
      }
    }
    return cell;
  }

  void walk(const WalkRay& ray, uint32_t start, WalkLength& length) const {
    uint32_t cell = start;
    float entry = 0, logTransmittance = 0;
    while (cell != kNoCell && logTransmittance >= kLogCutoff) {
      float exit = std::numeric_limits<float>::infinity();
      const uint32_t next = findNext(ray, cell, exit);
      exit = std::max(exit, entry);
      if (cells_.densities[cell] > 0) logTransmittance -= opticalDepth(ray, cell, entry, exit);
      length.neighbours += graph_.offsets[cell + 1] - graph_.offsets[cell];
      ++length.steps;
      cell = next;
      entry = exit;
    }
    ++length.rays;
  }

 private:
  double powerOf(uint32_t cell, const glm::dvec3& point) const {
    return foam::powerOfOrigin(glm::dvec3(cells_.sites[cell]) - point, double{cells_.radii[cell]});
  }

  // The neighbour through whose plane the ray leaves the cell first.
  uint32_t findNext(const WalkRay& ray, uint32_t cell, float& exit) const {
    const glm::vec3 site = cells_.sites[cell], centre = site - ray.origin;
    const float radius = cells_.radii[cell], key = glm::dot(ray.direction, centre);
    uint32_t next = kNoCell;
    float clearance = 1, q = 0;  // of the nearest plane
    for (uint32_t i = graph_.offsets[cell]; i < graph_.offsets[cell + 1]; ++i) {
      const uint32_t other = graph_.neighbours[i];
      const glm::vec3 otherSite = cells_.sites[other];
      if (!(glm::dot(ray.direction, otherSite - ray.origin) > key)) continue;
      const glm::vec3 toNeighbour = otherSite - site;
      const float otherQ = glm::dot(toNeighbour, ray.direction);
      const float offset = foam::radicalOffset(toNeighbour, radius, cells_.radii[other]);
      const float otherClearance = foam::radicalClearance(centre, toNeighbour, offset);
      if (!(otherQ > 0 && foam::exitLead(otherClearance, otherQ, clearance, q) > 0)) continue;
      clearance = otherClearance;
      q = otherQ;
      next = other;
    }
    if (next != kNoCell) exit = clearance / q;
    return next;
  }

  float opticalDepth(const WalkRay& ray, uint32_t cell, float entry, float exit) const {
    const glm::vec3 centre = cells_.sites[cell] - ray.origin;
    const float radius = cells_.radii[cell];
    if (foam::isNearCell(centre, radius, ray.forward, ray.nearRatio, ray.nearDepth)) return 0;
    float tNear, tFar;
    if (!foam::intersectBall(centre, radius, ray.direction, tNear, tFar)) return 0;
    tNear = std::max(tNear, entry);
    tFar = std::min(tFar, exit);
    if (!cells_.faces.empty()) {
      const glm::vec3 normal(cells_.faces[cell]);
      const float facing = glm::dot(normal, ray.direction);
      foam::clipByFace(centre, normal, facing, cells_.faces[cell].w, tNear, tFar);
    }
    return cells_.densities[cell] * std::max(tFar - tNear, 0.0f);
  }

  const WalkCells& cells_;
  const CellGraph& graph_;
};

// Processor time of the calling thread: other work on the machine does not count.
double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

uint32_t findWalkable(const CellGraph& graph) {
  for (uint32_t cell = 0; cell + 1 < graph.offsets.size(); ++cell) {
    if (graph.offsets[cell] < graph.offsets[cell + 1]) return cell;
  }
  return kNoCell;
}

}  // namespace

std::vector<glm::vec4> meanFaces(const Foam& foam) {
  std::vector<glm::vec4> faces(foam.cellCount);
  for (size_t i = 0; i < faces.size(); ++i) {
    float sum = 0;
    for (size_t k = i * foam.detailCount; k < (i + 1) * foam.detailCount; ++k) sum += foam.detailHeights[k];
    faces[i] = glm::vec4(faceFrame<float>(foam.orientations[i]).normal, foam.radii[i] * sum / float(foam.detailCount));
  }
  return faces;
}

std::vector<WalkRay> raysOfViews(std::span<const View> views, uint32_t raysPerView, double nearRatio, double nearDepth,
                                 uint64_t seed) {
  std::vector<WalkRay> rays;
  uint64_t draws = 0;
  const CounterRandom random(seed, Purpose::kSubpixel);
  for (const View& view : views) {
    const ViewRays viewRays(view);
    const bool isOrthographic = view.lens.kind == LensKind::kOrthographic;
    const double ownRatio = isOrthographic ? 0 : view.nearRatio.value_or(nearRatio);
    const double ownDepth = looksForward(view.lens.kind) ? view.nearDepth.value_or(nearDepth) : 0;
    const double pitch = std::sqrt(double(view.width) * view.height / raysPerView);  // [pixels]
    const auto columns = static_cast<uint32_t>(std::max(1.0, view.width / pitch));
    const auto rows = static_cast<uint32_t>(std::max(1.0, view.height / pitch));
    for (uint32_t place = 0; place < columns * rows; ++place) {
      const double x = (place % columns + random.uniform(2 * draws)) * view.width / columns;
      const double y = (place / columns + random.uniform(2 * draws + 1)) * view.height / rows;
      ++draws;
      const std::optional<ViewRay> ray = viewRays.at(x, y);
      if (!ray) continue;
      rays.push_back({eyeOf(view) + ray->offset, ray->direction, forwardOf(view), static_cast<float>(ownRatio),
                      static_cast<float>(ownDepth)});
    }
  }
  return rays;
}

WalkLength measureWalkLength(const WalkCells& cells, const CellGraph& graph, std::span<const WalkRay> rays) {
  const uint32_t first = findWalkable(graph);
  if (first == kNoCell) return {rays.size(), rays.size(), 0, 0};
  const Walker walker(cells, graph);
  std::vector<WalkLength> lengths((rays.size() + kRaysPerBlock - 1) / kRaysPerBlock);
  tbb::parallel_for(size_t{0}, lengths.size(), [&](size_t block) {
    const auto own = rays.subspan(block * kRaysPerBlock, std::min(kRaysPerBlock, rays.size() - block * kRaysPerBlock));
    std::vector<uint32_t> starts;
    for (const WalkRay& ray : own) starts.push_back(walker.locate(ray.origin, starts.empty() ? first : starts.back()));
    WalkLength length;
    const double begin = threadSeconds();
    for (size_t i = 0; i < own.size(); ++i) walker.walk(own[i], starts[i], length);
    length.seconds = threadSeconds() - begin;
    lengths[block] = length;
  });
  WalkLength sum;
  for (const WalkLength& length : lengths) {
    sum.rays += length.rays;
    sum.steps += length.steps;
    sum.neighbours += length.neighbours;
    sum.seconds += length.seconds;
  }
  return sum;
}

}  // namespace froth
