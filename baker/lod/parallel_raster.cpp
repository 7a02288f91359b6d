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
Foam copyGeometry(const Foam& foam) {
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

}  // namespace

std::vector<RayGrid> gridsAround(float radius, uint32_t count, uint32_t size, uint64_t seed) {
  const CounterRandom random(seed, Purpose::kDirection);
  const glm::dvec3 axis = random.direction(0);
  const glm::dvec3 side =
      glm::normalize(glm::cross(axis, std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
  const double turn = random.uniform(2, 0, glm::two_pi<double>());
  const glm::dvec3 first = std::cos(turn) * side + std::sin(turn) * glm::cross(axis, side);
  const glm::dmat3 rotation(first, glm::cross(axis, first), axis);
  std::vector<RayGrid> grids;
  for (const glm::dvec3& direction : directionsAround(count)) {
    const glm::dvec3 forward = rotation * direction;
    const glm::dvec3 up = std::abs(forward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    grids.push_back({right, glm::cross(forward, right), forward, size, 2 * radius / static_cast<float>(size)});
  }
  return grids;
}

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

ParallelRaster::ParallelRaster(const Foam& foam, const glm::dvec3& centre) : foam_(foam) {
  const Foam geometry = copyGeometry(foam);
  ReferenceOptions options;
  options.nearRatio = 0;
  cells_ = prepareViewCells<float>(geometry, findCechPairs(geometry.sites, geometry.radii), findVisibleCells(geometry),
                                   parallelView(centre), options);
  sources_.resize(cells_.cells.size());
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    if (cells_.rankOf[cell] != ViewCells<float>::kNotDrawn) sources_[cells_.rankOf[cell]] = cell;
  }
  for (const ViewCell<float>& cell : cells_.cells) {
    reach_ = std::max(reach_, glm::length(cell.centre) + cell.radius);
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
