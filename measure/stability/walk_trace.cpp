#include "measure/stability/walk_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/camera/view_rays.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr uint32_t kNoCell = UINT32_MAX;

class Tracer {
 public:
  Tracer(const Foam& foam, const CellGraph& graph, const View& view)
      : foam_(foam),
        graph_(graph),
        isParallel_(view.lens.kind == LensKind::kOrthographic),
        lastVisit_(foam.cellCount, 0) {
    for (const glm::vec3& site : foam.sites) {
      centres_.push_back(glm::dvec3(site) - eyeOf(view));
      farthest_ = std::max(farthest_, glm::length(centres_.back()));
    }
  }

  void trace(const ViewRay& ray, uint32_t start, WalkTrace& trace) {
    // Two keys of up to `farthest_`, each a sum of three rounded products.
    const double rounding = 8 * 0x1p-24 * farthest_;
    uint32_t cell = locate(ray.offset, start);
    uint64_t steps = 1;
    ++trace.rays;
    lastVisit_[cell] = trace.rays;
    for (uint32_t next; (next = findNext(ray, cell)) != kNoCell; cell = next, ++steps) {
      const bool falls = keyOf(next, ray) < keyOf(cell, ray) - rounding, returns = lastVisit_[next] == trace.rays;
      if (falls || returns) ++trace.violations;
      lastVisit_[next] = trace.rays;
      if (steps > foam_.cellCount) break;
    }
    trace.steps += steps;
    trace.mostSteps = std::max(trace.mostSteps, steps);
    if (keyOf(cell, ray) < largestKey(ray) - rounding) ++trace.lost;
  }

 private:
  double keyOf(uint32_t cell, const ViewRay& ray) const { return glm::dot(ray.direction, centres_[cell]); }

  // Of cells that are in the graph.
  double largestKey(const ViewRay& ray) const {
    double largest = -std::numeric_limits<double>::infinity();
    for (uint32_t cell = 0; cell < foam_.cellCount; ++cell) {
      if (graph_.offsets[cell] < graph_.offsets[cell + 1]) largest = std::max(largest, keyOf(cell, ray));
    }
    return largest;
  }

  double powerOf(uint32_t cell, const glm::dvec3& offset) const {
    return foam::powerOfOrigin(centres_[cell] - offset, double{foam_.radii[cell]});
  }

  uint32_t locate(const glm::dvec3& offset, uint32_t cell) const {
    for (uint32_t previous = kNoCell; cell != previous;) {
      previous = cell;
      for (const uint32_t other : neighboursOf(graph_, previous)) {
        if (powerOf(other, offset) < powerOf(cell, offset)) cell = other;
      }
    }
    return cell;
  }

  // As findNextSite() of the shader.
  uint32_t findNext(const ViewRay& ray, uint32_t cell) const {
    const glm::vec3 direction(ray.direction), offset(ray.offset), centre(centres_[cell]);
    const float radius = foam_.radii[cell], key = glm::dot(direction, centre);
    float most = isParallel_ ? -std::numeric_limits<float>::infinity() : 0.0f;
    uint32_t next = kNoCell;
    for (const uint32_t other : neighboursOf(graph_, cell)) {
      if (!(glm::dot(direction, glm::vec3(centres_[other])) > key)) continue;
      const glm::vec3 toNeighbour = foam_.sites[other] - foam_.sites[cell];
      const float plane = foam::radicalOffset(toNeighbour, radius, foam_.radii[other]);
      const float nearness = nearnessOf(centre, toNeighbour, plane, direction, offset);
      if (nearness > most) most = nearness, next = other;
    }
    return next;
  }

  // Of the point where the ray leaves through a plane; -infinity: it does not.
  float nearnessOf(const glm::vec3& centre, const glm::vec3& toNeighbour, float plane, const glm::vec3& direction,
                   const glm::vec3& offset) const {
    constexpr float kNone = -std::numeric_limits<float>::infinity();
    const float clearance = foam::radicalClearance(centre, toNeighbour, plane);
    if (isParallel_) {
      const float q = glm::dot(toNeighbour, direction);
      return q > 0 ? (glm::dot(toNeighbour, offset) - clearance) / q : kNone;
    }
    const float exit = foam::exitClearance(centre, toNeighbour, plane, clearance);
    return exit >= 0 ? glm::dot(foam::eyePlane(toNeighbour, exit, true), direction) : kNone;
  }

  const Foam& foam_;
  const CellGraph& graph_;
  const bool isParallel_;
  std::vector<glm::dvec3> centres_;  // relative to the eye
  double farthest_ = 0;
  std::vector<uint64_t> lastVisit_;  // [cells] number of the ray
};

}  // namespace

WalkTrace traceWalks(const Foam& foam, const CellGraph& graph, const View& view) {
  WalkTrace trace;
  uint32_t start = 0;
  while (start < foam.cellCount && graph.offsets[start] == graph.offsets[start + 1]) ++start;
  if (start == foam.cellCount) return trace;  // one cell alone
  const ViewRays rays(view);
  Tracer tracer(foam, graph, view);
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      if (const std::optional<ViewRay> ray = rays.ofPixel(x, y)) tracer.trace(*ray, start, trace);
    }
  }
  return trace;
}

}  // namespace froth
