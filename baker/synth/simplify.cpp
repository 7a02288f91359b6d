#include "baker/synth/simplify.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <glm/gtc/constants.hpp>

#include "foam/detail_colour.h"
#include "foam/pick_foam.h"

namespace froth {
namespace {

constexpr int kDirections = 32;         // over a hemisphere
constexpr float kSomeHeight = 0x1p-4f;  // [radii]
constexpr float kSomeColour = 0x1p-4f;  // [display-coded]

// Fibonacci points on the hemisphere around +z.
std::array<glm::vec3, kDirections> hemisphere() {
  std::array<glm::vec3, kDirections> directions;
  for (int i = 0; i < kDirections; ++i) {
    const double z = (i + 0.5) / kDirections;
    const double angle = i * glm::pi<double>() * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    directions[i] = glm::vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return directions;
}

// Shares of the unit disc that are nearest to each of a cell's detail sites, on a grid.
std::vector<int> faceShares(const Foam& foam, uint32_t cell) {
  constexpr int kGrid = 16;
  std::vector<int> shares(foam.detailCount, 0);
  const glm::vec2* details = &foam.detailSites[size_t{cell} * foam.detailCount];
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      const glm::vec2 place = glm::vec2(x + 0.5f, y + 0.5f) * (2.0f / kGrid) - 1.0f;
      if (glm::dot(place, place) > 1) continue;
      const auto nearer = [&](const glm::vec2& a, const glm::vec2& b) {
        return glm::dot(a - place, a - place) < glm::dot(b - place, b - place);
      };
      ++shares[std::min_element(details, details + foam.detailCount, nearer) - details];
    }
  }
  return shares;
}

std::vector<uint32_t> largestShares(const Foam& foam, uint32_t cell, uint32_t count) {
  const std::vector<int> shares = faceShares(foam, cell);
  std::vector<uint32_t> order(foam.detailCount);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return shares[a] > shares[b]; });
  order.resize(count);
  std::sort(order.begin(), order.end());
  return order;
}

// The foam with `count` detail sites per cell: those of `picked`, of which each cell has as many, in the order of the
// cells.
Foam pickDetailSites(const Foam& foam, uint32_t count, const std::vector<uint64_t>& picked) {
  std::vector<uint32_t> cells(foam.cellCount);
  std::iota(cells.begin(), cells.end(), 0u);
  return pickFoam(foam, {.cells = cells, .details = picked, .detailCount = count, .mostLobes = foam.lobeCount});
}

}  // namespace

Foam withoutViewDependence(const Foam& foam) {
  Foam flat = foam;
  const std::array<glm::vec3, kDirections> before = hemisphere();
  const size_t details = size_t{foam.cellCount} * foam.detailCount;
  flat.lobeCount = 1;
  flat.lobeOffsets.clear();
  flat.baseColours.clear();
  flat.lobeAxes.assign(details, glm::vec3(0));
  flat.lobeColours.resize(details);
  tbb::parallel_for(uint32_t{0}, foam.cellCount, [&](uint32_t cell) {
    const FaceFrame<float> frame = faceFrame<float>(foam.orientations[cell]);
    for (uint32_t k = 0; k < foam.detailCount; ++k) {
      const uint64_t detail = uint64_t{cell} * foam.detailCount + k;
      glm::vec3 sum(0);
      for (const glm::vec3& d : before) {
        sum += detailColour(foam, detail, -(d.x * frame.tangent + d.y * frame.bitangent + d.z * frame.normal));
      }
      flat.lobeColours[detail] = sum / static_cast<float>(kDirections) - 0.5f;
    }
  });
  return flat;
}

Foam withoutDisplacement(const Foam& foam) {
  Foam plain = foam;
  std::fill(plain.detailHeights.begin(), plain.detailHeights.end(), 0.0f);
  return plain;
}

Foam withFewerDetailSites(const Foam& foam, uint32_t count) {
  std::vector<uint64_t> picked;
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    for (const uint32_t k : largestShares(foam, cell, count)) picked.push_back(uint64_t{cell} * foam.detailCount + k);
  }
  return pickDetailSites(foam, count, picked);
}

Foam withSomeDisplacement(const Foam& foam) {
  Foam displaced = foam;
  for (size_t i = 0; i < displaced.detailHeights.size(); ++i) {
    displaced.detailHeights[i] = i % 2 ? kSomeHeight : -kSomeHeight;
  }
  return displaced;
}

Foam withSomeDetailSites(const Foam& foam) {
  std::vector<uint64_t> picked;
  for (uint64_t detail = 0; detail < foam.detailSites.size(); ++detail) picked.insert(picked.end(), 2, detail);
  Foam detailed = pickDetailSites(foam, 2, picked);
  for (size_t detail = 0; detail < detailed.detailSites.size(); ++detail) {
    const float sign = detail % 2 ? 1.0f : -1.0f;
    detailed.detailSites[detail].x += sign * 0.5f;
    const LobeRange lobes = lobesOf(detailed, detail);
    for (uint64_t m = lobes.first; m < lobes.first + lobes.count; ++m) detailed.lobeColours[m] += sign * kSomeColour;
  }
  return detailed;
}

Foam withSomeViewDependence(const Foam& foam) {
  const Foam flat = withoutViewDependence(foam);
  Foam varied = flat;
  varied.lobeCount = 2;
  varied.lobeAxes.clear();
  varied.lobeColours.clear();
  for (const glm::vec3& colour : flat.lobeColours) {
    for (const float sign : {1.0f, -1.0f}) {
      varied.lobeAxes.emplace_back(sign * 2, 0, 0);
      varied.lobeColours.push_back(colour + sign * kSomeColour);
    }
  }
  return varied;
}

}  // namespace froth
