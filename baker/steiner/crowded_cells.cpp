#include "baker/steiner/crowded_cells.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "baker/steiner/empty_balls.h"
#include "base/counter_random.h"
#include "foam/morton_order.h"

namespace froth {
namespace {

constexpr size_t kMostNeighbours = 1024;  // of a cell that is not crowded
constexpr uint64_t kNeighboursPerBall = 64;
constexpr double kNearest = 1.0 / 32, kFarthest = 0.5;  // of the way from a neighbour to the crowded site
constexpr uint64_t kCrowdedClimbs = 4;

}  // namespace

SteinerCells splitCrowdedCells(std::span<const glm::vec3> sites, std::span<const float> radii, size_t realCount,
                               const CellGraph& graph, const SteinerOptions& options, uint32_t round) {
  std::vector<uint32_t> crowded;
  for (uint32_t cell = 0; cell < sites.size(); ++cell) {
    if (neighboursOf(graph, cell).size() > kMostNeighbours) crowded.push_back(cell);
  }
  SteinerCells added;
  if (crowded.empty()) return added;
  const std::span<const glm::vec3> real = sites.first(realCount);
  const SiteTree tree(real, radii.first(realCount), mortonOrder(real));
  const EmptyBallFinder finder(tree, real, radii.first(realCount), options);
  std::vector<std::vector<EmptyBall>> found(crowded.size());
  tbb::parallel_for(size_t{0}, crowded.size(), [&](size_t i) {
    const CounterRandom random(options.seed, Purpose::kCrowd, (uint64_t{round} << 32) + crowded[i]);
    for (const uint32_t neighbour : neighboursOf(graph, crowded[i])) {
      const uint64_t draw = 3 * uint64_t{neighbour};
      if (random.bits(draw) % kNeighboursPerBall != 0) continue;
      // Near the neighbour and far from it, so that balls of all sizes come.
      const double share = kNearest * std::pow(kFarthest / kNearest, random.uniform(draw + 1));
      const glm::dvec3 place = glm::mix(glm::dvec3(sites[neighbour]), glm::dvec3(sites[crowded[i]]), share);
      finder.findAt(place, static_cast<uint32_t>(random.bits(draw + 2) % kCrowdedClimbs), found[i]);
    }
  });
  std::vector<EmptyBall> balls;
  for (const std::vector<EmptyBall>& some : found) balls.insert(balls.end(), some.begin(), some.end());
  dropTwins(balls);
  for (const EmptyBall& ball : balls) {
    added.sites.push_back(ball.site);
    added.radii.push_back(ball.radius);
  }
  return added;
}

}  // namespace froth
