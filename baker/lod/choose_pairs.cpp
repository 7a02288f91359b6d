#include "baker/lod/choose_pairs.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "foam/cech_pairs.h"
#include "foam/detail_colour.h"
#include "shaders/foam/compositing.h"

namespace froth {
namespace {

// Weights of what differs, beside a squared difference of colour; tried on miku_plush (docs/notes/levels.md).
constexpr double kOfNormals = 0.1, kOfFaces = 0.1, kOfDistance = 0.1, kOfOpacity = 0.1, kOfSizes = 0.02;
constexpr double kLeastContribution = 1e-3;  // of the mean: orders pairs of cells that no view shows

constexpr size_t kMostEyes = 4;  // from which a cell's colour is the mean

// What the cost of a pair asks of a cell.
struct CellLook {
  glm::dvec3 site, normal, colour;
  double radius, opacity, contribution;
};

// The mean colour of a face from some eyes before it; from straight before it where there are none.
glm::dvec3 meanColour(const Foam& cells, uint32_t cell, const CellLook& look, std::span<const glm::vec3> eyes) {
  std::vector<glm::vec3> directions;
  const size_t count = std::min(kMostEyes, eyes.size());
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec3 direction = glm::normalize(look.site - glm::dvec3(eyes[i * eyes.size() / count]));
    if (glm::dot(direction, look.normal) < 0) directions.emplace_back(direction);
  }
  if (directions.empty()) directions.emplace_back(-look.normal);
  glm::dvec3 sum(0);
  for (uint32_t k = 0; k < cells.detailCount; ++k) {
    for (const glm::vec3& direction : directions) {
      sum += glm::dvec3(detailColour(cells, uint64_t{cell} * cells.detailCount + k, direction));
    }
  }
  return sum / double(cells.detailCount * directions.size());
}

CellLook lookAt(const Foam& cells, uint32_t cell, double contribution, std::span<const glm::vec3> eyes) {
  CellLook look;
  look.site = cells.sites[cell];
  look.radius = cells.radii[cell];
  look.normal = faceFrame<double>(cells.orientations[cell]).normal;
  look.opacity = foam::opacity(double{cells.densities[cell]} * look.radius);
  look.contribution = contribution;
  look.colour = meanColour(cells, cell, look, eyes);
  return look;
}

double costOf(const CellLook& a, const CellLook& b) {
  const glm::dvec3 between = b.site - a.site, colours = b.colour - a.colour;
  const double size = a.radius + b.radius, ratio = std::log(a.radius / b.radius);
  const double faces = 0.5 * (std::abs(glm::dot(a.normal, between)) + std::abs(glm::dot(b.normal, between))) / size;
  const double opacity = a.opacity - b.opacity;
  const double difference = glm::dot(colours, colours) + kOfNormals * (1 - glm::dot(a.normal, b.normal)) +
                            kOfFaces * faces * faces + kOfDistance * glm::dot(between, between) / (size * size) +
                            kOfOpacity * opacity * opacity + kOfSizes * ratio * ratio;
  return a.contribution * b.contribution / (a.contribution + b.contribution) * difference;
}

// Cells that may be in a pair.
std::vector<uint32_t> findFree(const Foam& cells, std::span<const uint8_t> isLocked) {
  std::vector<uint32_t> free;
  for (uint32_t cell = 0; cell < cells.cellCount; ++cell) {
    if (cells.densities[cell] > 0 && isLocked[cell] == 0) free.push_back(cell);
  }
  return free;
}

}  // namespace

std::vector<CellPair> choosePairs(const Foam& cells, std::span<const uint8_t> isLocked,
                                  std::span<const double> contributions, size_t most, std::span<const glm::vec3> eyes) {
  const std::vector<uint32_t> free = findFree(cells, isLocked);
  if (free.empty()) return {};
  double total = 0;
  for (const uint32_t cell : free) total += contributions.empty() ? 1 : contributions[cell];
  const double least = total > 0 ? kLeastContribution * total / double(free.size()) : 1;
  std::vector<glm::vec3> sites(free.size());
  std::vector<float> radii(free.size());
  std::vector<CellLook> looks(free.size());
  tbb::parallel_for(size_t{0}, free.size(), [&](size_t i) {
    sites[i] = cells.sites[free[i]];
    radii[i] = cells.radii[free[i]];
    looks[i] = lookAt(cells, free[i], std::max(contributions.empty() ? 1 : contributions[free[i]], least), eyes);
  });
  const CellGraph overlaps = findCechPairs(sites, radii);

  struct Candidate {
    double cost;
    uint32_t first, second;
    bool operator<(const Candidate& other) const {
      return std::tie(cost, first, second) < std::tie(other.cost, other.first, other.second);
    }
  };
  std::vector<Candidate> candidates;
  for (uint32_t i = 0; i < free.size(); ++i) {
    for (const uint32_t j : neighboursOf(overlaps, i)) {
      if (i < j) candidates.push_back({costOf(looks[i], looks[j]), i, j});
    }
  }
  tbb::parallel_sort(candidates.begin(), candidates.end());
  std::vector<CellPair> pairs;
  std::vector<uint8_t> isTaken(free.size(), 0);
  for (const Candidate& candidate : candidates) {
    if (pairs.size() == most) break;
    if (isTaken[candidate.first] || isTaken[candidate.second]) continue;
    isTaken[candidate.first] = isTaken[candidate.second] = 1;
    pairs.push_back({free[candidate.first], free[candidate.second]});
  }
  return pairs;
}

}  // namespace froth
