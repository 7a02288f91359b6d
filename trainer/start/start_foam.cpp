#include "trainer/start/start_foam.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>
#include <glm/gtc/quaternion.hpp>

#include "foam/checkpoint/activation.h"
#include "foam/checkpoint/parameters.h"
#include "foam/morton_order.h"
#include "trainer/start/cover_views.h"
#include "trainer/start/nearest_sites.h"
#include "trainer/start/start_streams.h"

namespace froth {
namespace {

constexpr double kPointShare = 0.95;   // of the points: the last ones lie closest to others
constexpr double kMixFrom = 0.9;       // of the points: as many cells, and mixtures begin
constexpr uint64_t kMostMixtures = 9;  // for each point
constexpr uint32_t kNearest = 8;       // distances in a radius
constexpr double kGapShare = 0.75;     // of the cells that may cover gaps
constexpr double kLeastRadius = 1e-4;  // cells at one place, and before a lens, keep a radius that trains
constexpr double kRawDensity = 0.1, kSiteSpread = 0.1, kAxisSpread = 2;

// Rows n, t, b with n along `towards`, or at random where that is 0.
glm::vec4 orientationTo(const glm::dvec3& towards, const CounterRandom& random, uint32_t cell) {
  constexpr double kLeast = 1e-9;  // views from all sides cancel out
  const bool isKnown = glm::length(towards) > kLeast;
  const glm::dvec3 n = isKnown ? glm::normalize(towards) : random.direction(2 * uint64_t{cell});
  glm::dvec3 t = glm::cross(n, random.direction(2 * uint64_t{cell} + 1));
  // Parallel by chance: any other direction serves.
  if (!(glm::length(t) > kLeast)) t = glm::cross(n, std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
  t = glm::normalize(t);
  const glm::dquat q = glm::normalize(glm::quat_cast(glm::transpose(glm::dmat3(n, t, glm::cross(n, t)))));
  return normaliseQuaternion({q.w, q.x, q.y, q.z});
}

std::vector<float> radiiOf(const std::vector<StartCell>& cells) {
  std::vector<glm::vec3> sites;
  for (const StartCell& cell : cells) sites.emplace_back(cell.position);
  const std::vector<float> zeros(cells.size(), 0.0f);
  std::vector<uint32_t> members(cells.size());
  std::iota(members.begin(), members.end(), 0u);
  const SiteTree tree(sites, zeros, std::move(members));
  std::vector<float> radii(cells.size());
  tbb::parallel_for(size_t{0}, cells.size(), [&](size_t i) {
    const std::vector<NearSite> nearest = findNearestSites(tree, sites, glm::dvec3(sites[i]), kNearest);
    double sum = 0;
    for (const NearSite& near : nearest) sum += std::sqrt(near.squared);
    const double mean = sum / static_cast<double>(nearest.size());
    radii[i] = static_cast<float>(std::max(std::min(mean, cells[i].mostRadius), kLeastRadius));
  });
  return radii;
}

// Steps look for pairs between runs of cells that follow each other (trainer/cuda/find_pairs.cu).
std::vector<StartCell> sortAlongCurve(const std::vector<StartCell>& cells) {
  std::vector<glm::vec3> sites;
  for (const StartCell& cell : cells) sites.emplace_back(cell.position);
  std::vector<StartCell> sorted;
  sorted.reserve(cells.size());
  for (const uint32_t cell : mortonOrder(sites)) sorted.push_back(cells[cell]);
  return sorted;
}

// Cells that cover gaps stand in place of the last ones, which matter least.
uint32_t coverGaps(const StartScene& scene, std::vector<StartCell>& cells) {
  const auto most = static_cast<uint32_t>(kGapShare * static_cast<double>(cells.size()));
  const std::vector<StartCell> gaps = cellsInGaps(scene, cells, radiiOf(cells), most);
  std::copy(gaps.begin(), gaps.end(), cells.end() - static_cast<std::ptrdiff_t>(gaps.size()));
  return static_cast<uint32_t>(gaps.size());
}

void setAppearance(const std::vector<StartCell>& cells, uint64_t seed, Foam& foam) {
  const CounterRandom sites = startRandom(seed, StartStream::kDetailSites),
                      axes = startRandom(seed, StartStream::kAxes);
  const size_t details = size_t{foam.cellCount} * foam.detailCount, lobes = details * foam.lobeCount;
  foam.detailSites.resize(details);
  foam.detailHeights.assign(details, 0.0f);
  foam.lobeAxes.resize(lobes);
  foam.lobeColours.resize(lobes);
  tbb::parallel_for(size_t{0}, details, [&](size_t detail) {
    for (int axis = 0; axis < 2; ++axis) {
      foam.detailSites[detail][axis] = static_cast<float>(kSiteSpread * normalAt(sites, 2 * detail + size_t(axis)));
    }
    const glm::vec3 colour = cells[detail / foam.detailCount].colour - 0.5;
    for (size_t lobe = detail * foam.lobeCount; lobe < (detail + 1) * foam.lobeCount; ++lobe) {
      foam.lobeColours[lobe] = colour;
      for (int axis = 0; axis < 3; ++axis) {
        foam.lobeAxes[lobe][axis] = static_cast<float>(kAxisSpread * normalAt(axes, 3 * lobe + size_t(axis)));
      }
    }
  });
}

Foam foamOf(const std::vector<StartCell>& cells, const StartOptions& options, const StartScene& scene) {
  Foam foam;
  foam.cellCount = options.cellCount;
  foam.detailCount = options.detailCount;
  foam.lobeCount = options.lobeCount;
  for (const StartCell& cell : cells) foam.sites.emplace_back(cell.position);
  const CounterRandom normals = startRandom(scene.seed, StartStream::kNormal);
  foam.orientations.resize(cells.size());
  tbb::parallel_for(uint32_t{0}, foam.cellCount,
                    [&](uint32_t i) { foam.orientations[i] = orientationTo(cells[i].towards, normals, i); });
  foam.radii = radiiOf(cells);
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const float unit = unitAt(scene.eyes, glm::vec4(foam.sites[i], foam.radii[i]));
    foam.densities.push_back(static_cast<float>(softplus(kRawDensity)) / unit);
  }
  setAppearance(cells, scene.seed, foam);
  return foam;
}

bool isIn(uint32_t value, uint64_t most) { return value >= 1 && value <= most; }

}  // namespace

Result<StartFoam> makeStartFoam(const StartScene& scene, const StartOptions& options) {
  if (!isIn(options.cellCount, UINT32_MAX) || !isIn(options.detailCount, kMaxDetails) ||
      !isIn(options.lobeCount, kMaxLobes)) {
    return makeError(ErrorKind::kUsage, "a start of %u cells, %u detail sites, %u lobes; give >= 1, 1..32, 1..32",
                     options.cellCount, options.detailCount, options.lobeCount);
  }
  if (scene.training.empty()) return makeError(ErrorKind::kUsage, "a start without training views; give some");
  const std::vector<StartCell> points = cellsOfPoints(scene);
  StartFoam start;
  start.points = std::min(options.cellCount, static_cast<uint32_t>(kPointShare * static_cast<double>(points.size())));
  const uint32_t rest = options.cellCount - start.points;
  const bool mixes = points.size() >= kMixed && options.cellCount >= kMixFrom * static_cast<double>(points.size());
  if (mixes) start.mixtures = static_cast<uint32_t>(std::min<uint64_t>(rest, kMostMixtures * points.size()));
  start.random = rest - start.mixtures;

  std::vector<StartCell> cells(points.begin(), points.begin() + start.points);
  if (mixes) {
    const std::vector<StartCell> mixed = mixCells(points, start.mixtures, scene.seed);
    cells.insert(cells.end(), mixed.begin(), mixed.end());
  }
  const std::vector<StartCell> random = cellsInFrusta(scene, start.random);
  cells.insert(cells.end(), random.begin(), random.end());
  limitRadii(scene, cells);
  start.gaps = coverGaps(scene, cells);
  start.foam = foamOf(sortAlongCurve(cells), options, scene);
  return start;
}

}  // namespace froth
