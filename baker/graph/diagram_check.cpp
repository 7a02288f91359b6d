#include "baker/graph/diagram_check.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/counter_random.h"
#include "foam/morton_order.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/next_cell.h"

namespace froth {
namespace {

// Rounding of a power, of the size |x - p|^2 + r^2, and of a place on a ray, of the size |x| + t: some
// roundings of 2^-53 each, thousandfold.
constexpr double kPowerSlack = 0x1p-43;
// A bounded cell is cut alike if the lengths agree to this, in radii: the planes left out miss the ball by
// more than their rounding, so lengths differ only where a ray all but grazes a plane.
constexpr double kLengthSlack = 0x1p-20;
constexpr uint32_t kDrawsPerSample = 16;

}  // namespace

DiagramCheck::DiagramCheck(std::span<const glm::vec3> sites, std::span<const float> radii,
                           const RegularTriangulation& triangulation, const AlphaComplex& alpha, uint64_t seed)
    : sites_(sites),
      radii_(radii),
      triangulation_(triangulation),
      alpha_(alpha),
      seed_(seed),
      tree_(sites, radii, mortonOrder(sites)),
      low_(sites[0]),
      high_(sites[0]) {
  for (const glm::vec3& site : sites) {
    low_ = glm::min(low_, glm::dvec3(site));
    high_ = glm::max(high_, glm::dvec3(site));
  }
}

void DiagramCheck::checkPoint(uint32_t number, std::vector<std::string>& faults) const {
  const CounterRandom random(seed_, Purpose::kSite);
  const uint64_t sample = uint64_t{number} * kDrawsPerSample;
  const uint32_t cell = visibleFrom(random.bits(sample));
  glm::dvec3 x = number % 4 == 0 ? pointInScene(sample) : pointInBall(sample, cell);
  if (number % 4 >= 2) x = pointByFace(sample, x);
  const uint32_t start = number % 16 == 0 ? visibleFrom(random.bits(sample + 1)) : cell;
  checkLeast(x, 0, descend(x, start), "a walk to a point", faults);
}

void DiagramCheck::checkRay(uint32_t number, std::vector<std::string>& faults) const {
  const CounterRandom random(seed_, Purpose::kDirection);
  const uint64_t sample = uint64_t{number} * kDrawsPerSample;
  const uint32_t target = visibleFrom(random.bits(sample));
  Ray ray{pointInScene(~sample), {}};
  const glm::dvec3 towards = pointInBall(~sample, target) - ray.origin;
  const double distance = glm::length(towards);
  ray.direction = distance > 0 ? towards / distance : random.direction(sample + 1);

  const std::vector<Step> steps = walk(ray, descend(ray.origin, target), faults);
  for (const uint32_t cell : findBallsOn(ray)) {
    const bool isHidden = triangulation_.isHidden[cell];
    Interval whole, kept;
    if (!isHidden) whole = boundedCell(ray, cell, neighboursOf(triangulation_.graph, cell));
    if (!isHidden && !alpha_.isEmpty[cell]) kept = boundedCell(ray, cell, neighboursOf(alpha_.graph, cell));
    const double radius = radii_[cell];
    if (!(std::abs(kept.length() - whole.length()) <= kLengthSlack * radius)) {
      faults.push_back(fmt::format("ray {}: {} radii of cell {} by the alpha-complex, {} by the triangulation", number,
                                   kept.length() / radius, cell, whole.length() / radius));
    }
    if (!(whole.length() > 0)) continue;
    const double along = glm::dot(glm::dvec3(sites_[cell]) - ray.origin, ray.direction);
    const double t = along + 0.5 * (whole.near + whole.far);
    checkLeast(ray.origin + t * ray.direction, t, cellAt(steps, t), "within a ball on a ray", faults);
  }
}

uint32_t DiagramCheck::visibleFrom(uint64_t cell) const {
  cell %= sites_.size();
  while (triangulation_.isHidden[cell]) cell = (cell + 1) % sites_.size();
  return static_cast<uint32_t>(cell);
}

glm::dvec3 DiagramCheck::pointInBall(uint64_t sample, uint32_t cell) const {
  const CounterRandom random(seed_, Purpose::kRadius);
  const double distance = double{radii_[cell]} * std::cbrt(random.uniform(sample));
  return glm::dvec3(sites_[cell]) + distance * random.direction(sample + 1);
}

glm::dvec3 DiagramCheck::pointInScene(uint64_t sample) const {
  const CounterRandom random(seed_, Purpose::kEye);
  const glm::dvec3 place(random.uniform(sample), random.uniform(sample + 1), random.uniform(sample + 2));
  return low_ + place * (high_ - low_);
}

// A point all but on the face through which a random ray from `start` leaves its cell.
glm::dvec3 DiagramCheck::pointByFace(uint64_t sample, const glm::dvec3& start) const {
  const Ray ray{start, CounterRandom(seed_, Purpose::kFrame).direction(sample)};
  double t = 0;
  const uint32_t cell = tree_.findLeastPower(start).site;
  if (nextOnRay(ray, cell, t) == cell) return start;
  const double nudge = (sample & kDrawsPerSample) != 0 ? 1 + 0x1p-30 : 1 - 0x1p-30;
  return start + t * nudge * ray.direction;
}

// The end of a walk down the power, always to the best neighbour. Powers are compared by the place of x beside
// radical planes: seen from far, all cells of a cluster have the same rounded power, though only some lead on.
uint32_t DiagramCheck::descend(const glm::dvec3& x, uint32_t start) const {
  return descendAmong(x, start, [](uint32_t) { return true; });
}

template <class Takes>
uint32_t DiagramCheck::descendAmong(const glm::dvec3& x, uint32_t start, const Takes& takes) const {
  uint32_t cell = start;
  for (size_t steps = 0; steps < sites_.size(); ++steps) {
    const glm::dvec3 centre = glm::dvec3(sites_[cell]) - x;
    uint32_t best = cell;
    double least = 0;  // half the neighbour's power less the cell's
    for (const uint32_t neighbour : neighboursOf(triangulation_.graph, cell)) {
      const glm::dvec3 toNeighbour = glm::dvec3(sites_[neighbour]) - glm::dvec3(sites_[cell]);
      const double offset = foam::radicalOffset(toNeighbour, double{radii_[cell]}, double{radii_[neighbour]});
      const double clearance = foam::radicalClearance(centre, toNeighbour, offset);
      if (clearance < least && takes(neighbour)) {
        least = clearance;
        best = neighbour;
      }
    }
    if (best == cell) break;
    cell = best;
  }
  return cell;
}

// The cell behind the first radical plane on the ray's way out of a cell, and where; the cell itself if there
// is none.
uint32_t DiagramCheck::nextOnRay(const Ray& ray, uint32_t cell, double& t) const {
  const glm::dvec3 centre = glm::dvec3(sites_[cell]) - ray.origin;
  uint32_t next = cell;
  double clearance = 1, q = 0;  // of the nearest plane
  for (const uint32_t neighbour : neighboursOf(triangulation_.graph, cell)) {
    const glm::dvec3 toNeighbour = glm::dvec3(sites_[neighbour]) - glm::dvec3(sites_[cell]);
    const double otherQ = glm::dot(toNeighbour, ray.direction);
    const double offset = foam::radicalOffset(toNeighbour, double{radii_[cell]}, double{radii_[neighbour]});
    const double otherClearance = foam::radicalClearance(centre, toNeighbour, offset);
    if (!(otherQ > 0 && foam::exitLead(otherClearance, otherQ, clearance, q) > 0)) continue;
    clearance = otherClearance;
    q = otherQ;
    next = neighbour;
  }
  if (next == cell) return cell;
  t = std::max(t, clearance / q);
  // Seen from far, planes towards several cells lie at one rounded t, and from a wrong one no plane may lead on.
  return descendAmong(ray.origin + t * ray.direction, next, [&](uint32_t other) {
    return glm::dot(glm::dvec3(sites_[other]) - glm::dvec3(sites_[cell]), ray.direction) > 0;
  });
}

// x: a place on a ray at t, or a point with t = 0.
void DiagramCheck::checkLeast(const glm::dvec3& x, double t, uint32_t cell, const char* what,
                              std::vector<std::string>& faults) const {
  const NearestSite least = tree_.findLeastPower(x);
  const double power = powerAt(x, sites_[cell], radii_[cell]);
  if (power <= least.value) return;
  const auto powerTerms = [&](uint32_t site) {
    const glm::dvec3 local = x - glm::dvec3(sites_[site]);
    return glm::dot(local, local) + double{radii_[site]} * radii_[site];
  };
  const double apart = glm::length(glm::dvec3(sites_[cell]) - glm::dvec3(sites_[least.site]));
  const double slack = kPowerSlack * (powerTerms(cell) + powerTerms(least.site) + apart * (glm::length(x) + t));
  if (power - least.value <= slack) return;
  faults.push_back(fmt::format("{}: at ({}, {}, {}) cell {} has power {}, cell {} has {}", what, x.x, x.y, x.z, cell,
                               power, least.site, least.value));
}

// The cells that the ray meets from `cell` on, in order.
std::vector<DiagramCheck::Step> DiagramCheck::walk(const Ray& ray, uint32_t cell,
                                                   std::vector<std::string>& faults) const {
  std::vector<Step> steps;
  checkLeast(ray.origin, 0, cell, "the first cell on a ray", faults);
  double t = 0;
  for (const size_t before = faults.size(); steps.size() < sites_.size() && faults.size() == before;) {
    const uint32_t next = nextOnRay(ray, cell, t);
    if (next == cell) break;
    checkLeast(ray.origin + t * ray.direction, t, cell, "leaving a cell on a ray", faults);
    steps.push_back({cell, t});
    cell = next;
  }
  steps.push_back({cell, INFINITY});
  t += glm::length(high_ - low_);
  checkLeast(ray.origin + t * ray.direction, t, cell, "the last cell on a ray", faults);
  return steps;
}

// Where a walk is at t.
uint32_t DiagramCheck::cellAt(const std::vector<Step>& steps, double t) {
  return std::find_if(steps.begin(), steps.end() - 1, [t](const Step& step) { return t <= step.exit; })->cell;
}

std::vector<uint32_t> DiagramCheck::findBallsOn(const Ray& ray) const {
  std::vector<uint32_t> found;
  tree_.searchBallsOn(ray.origin, ray.direction, [&](uint32_t cell) { found.push_back(cell); });
  return found;
}

// What the ray has of a ball after the planes towards some neighbours; from the place next to the ball's
// centre, so that only lengths of the size of the cell are rounded.
DiagramCheck::Interval DiagramCheck::boundedCell(const Ray& ray, uint32_t cell,
                                                 std::span<const uint32_t> neighbours) const {
  const double radius = radii_[cell];
  glm::dvec3 centre = glm::dvec3(sites_[cell]) - ray.origin;
  const double along = glm::dot(centre, ray.direction);
  centre -= along * ray.direction;
  const double halfChord = std::sqrt(std::max(radius * radius - glm::dot(centre, centre), 0.0));
  Interval interval{std::max(-halfChord, -along), halfChord};
  for (const uint32_t neighbour : neighbours) {
    const glm::dvec3 toNeighbour = glm::dvec3(sites_[neighbour]) - glm::dvec3(sites_[cell]);
    const double offset = foam::radicalOffset(toNeighbour, radius, double{radii_[neighbour]});
    foam::clipByPlane(foam::radicalClearance(centre, toNeighbour, offset), glm::dot(toNeighbour, ray.direction),
                      foam::comesFirst(toNeighbour), interval.near, interval.far);
  }
  return interval;
}

}  // namespace froth
