#include "baker/lod/parallel_raster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "base/counter_random.h"
#include "foam/cech_pairs.h"
#include "foam/detail_colour.h"

namespace froth {
namespace {

constexpr uint32_t kCubeDirections = 14;

// Without colours: those of a direction are found where a cell is seen first.
Foam copyBalls(const Foam& foam) {
  Foam geometry;
  geometry.cellCount = foam.cellCount;
  geometry.detailCount = foam.detailCount;
  geometry.sites = foam.sites;
  geometry.radii = foam.radii;
  geometry.densities = foam.densities;
  geometry.orientations = foam.orientations;
  geometry.detailSites = foam.detailSites;
  geometry.detailHeights = foam.detailHeights;
  return geometry;
}

View parallelView(const glm::dvec3& centre) {
  View view;
  view.width = view.height = 1;
  view.lens.kind = LensKind::kOrthographic;
  view.worldFromCamera = {1, 0, 0, centre.x, 0, 1, 0, centre.y, 0, 0, 1, centre.z};
  return view;
}

// Unit directions: 6 faces and 8 corners of a cube; other counts are spread on a spiral.
std::vector<glm::dvec3> directionsAround(uint32_t count) {
  std::vector<glm::dvec3> directions;
  if (count == kCubeDirections) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) directions.emplace_back(0.0)[axis] = sign;
    }
    for (int corner = 0; corner < 8; ++corner) {
      directions.push_back(
          glm::normalize(glm::dvec3(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0)));
    }
    return directions;
  }
  for (uint32_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, angle = i * glm::pi<double>() * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return directions;
}

// Turns all of space by the seed.
glm::dmat3 drawRotation(uint64_t seed) {
  const CounterRandom random(seed, Purpose::kDirection);
  const glm::dvec3 axis = random.direction(0);
  const glm::dvec3 up = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 side = glm::normalize(glm::cross(axis, up));
  const double turn = random.uniform(2, 0, glm::two_pi<double>());
  const glm::dvec3 first = std::cos(turn) * side + std::sin(turn) * glm::cross(axis, side);
  return glm::dmat3(first, glm::cross(axis, first), axis);
}

RayGrid gridAlong(const glm::dvec3& forward, const FoamBall& ball, uint32_t size, double start) {
  const glm::dvec3 up = std::abs(forward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
  return {right,
          glm::cross(forward, right),
          forward,
          size,
          static_cast<float>(2 * ball.radius / size),
          static_cast<float>(start)};
}

}  // namespace

FoamBall boundVisibleCells(const Foam& foam) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  const auto visitVisible = [&](const auto& visit) {
    for (uint32_t i = 0; i < foam.cellCount; ++i) {
      if (foam.densities[i] > 0) visit(glm::dvec3(foam.sites[i]), double{foam.radii[i]});
    }
  };
  visitVisible([&](const glm::dvec3& site, double radius) {
    low = glm::min(low, site - radius);
    high = glm::max(high, site + radius);
  });
  if (!(low.x <= high.x)) return {};
  FoamBall ball{0.5 * (low + high), 0};
  visitVisible([&](const glm::dvec3& site, double radius) {
    ball.radius = std::max(ball.radius, glm::distance(site, ball.centre) + radius);
  });
  return ball;
}

std::vector<RayGrid> makeGrids(const FoamBall& ball, std::span<const glm::vec3> eyes, uint32_t count, uint32_t size,
                               uint64_t seed) {
  std::vector<RayGrid> grids;
  const size_t chosen = std::min<size_t>(count, eyes.size());
  for (size_t i = 0; i < chosen; ++i) {
    const glm::dvec3 toCentre = ball.centre - glm::dvec3(eyes[i * eyes.size() / chosen]);
    const double distance = glm::length(toCentre);
    if (distance > 0) grids.push_back(gridAlong(toCentre / distance, ball, size, -distance));
  }
  if (!grids.empty()) return grids;
  const glm::dmat3 rotation = drawRotation(seed);
  for (const glm::dvec3& direction : directionsAround(count)) {
    grids.push_back(gridAlong(rotation * direction, ball, size, -2 * ball.radius));
  }
  return grids;
}

ParallelRaster::ParallelRaster(const Foam& foam, const glm::dvec3& centre) : foam_(foam) {
  const Foam geometry = copyBalls(foam);
  ReferenceOptions options;
  options.nearRatio = 0;
  cells_ = prepareViewCells<float>(geometry, findCechPairs(geometry.sites, geometry.radii), findVisibleCells(geometry),
                                   parallelView(centre), options);
  sources_.resize(cells_.cells.size());
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    if (cells_.rankOf[cell] != ViewCells<float>::kNotDrawn) sources_[cells_.rankOf[cell]] = cell;
  }
}

std::vector<uint32_t> ParallelRaster::sortAlong(const glm::vec3& forward) const {
  std::vector<std::pair<float, uint32_t>> keys(cells_.cells.size());
  for (uint32_t rank = 0; rank < keys.size(); ++rank) {
    keys[rank] = {glm::dot(forward, cells_.cells[rank].centre), rank};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<uint32_t> order(keys.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = keys[i].second;
  return order;
}

void ParallelRaster::shade(uint32_t rank, const glm::vec3& forward, ViewDetail<float>* details) const {
  const auto own = cells_.detailsOf(rank);
  for (uint32_t k = 0; k < own.size(); ++k) {
    details[k] = own[k];
    details[k].colour = detailColour(foam_, uint64_t{sources_[rank]} * own.size() + k, forward);
  }
}

}  // namespace froth
