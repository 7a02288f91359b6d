#include "baker/steiner/steiner.h"

#include <algorithm>

#include "baker/steiner/ball_choice.h"
#include "baker/steiner/choosing_rays.h"
#include "baker/steiner/empty_balls.h"
#include "baker/steiner/ray_cells.h"
#include "baker/steiner/steps.h"
#include "foam/morton_order.h"

namespace froth {
namespace {

// More rays make a better choice and cost time: the limit keeps it small beside the rest of a large bake.
constexpr size_t kLeastRays = 1024, kMostRays = 8192;
constexpr size_t kCellsPerRay = 5;
constexpr uint64_t kLoops = 5;  // of Steps: cells of the rays, candidates, three of the choice

double meanLength(std::span<const RayCells> walks) {
  size_t sum = 0;
  for (const RayCells& walk : walks) sum += walk.count();
  return static_cast<double>(sum) / static_cast<double>(walks.size());
}

std::vector<EmptyBall> findBalls(const EmptyBallFinder& finder, std::span<const WalkRay> rays,
                                 std::span<const RayCells> walks, Steps& steps) {
  std::vector<std::vector<EmptyBall>> found(rays.size());
  steps.forAll(rays.size(), [&](size_t ray) { finder.findAlong(rays[ray], walks[ray], ray, found[ray]); });
  std::vector<EmptyBall> balls;
  for (const std::vector<EmptyBall>& some : found) balls.insert(balls.end(), some.begin(), some.end());
  dropTwins(balls);
  return balls;
}

}  // namespace

Result<SteinerCells> placeSteinerCells(std::span<const glm::vec3> sites, std::span<const float> radii,
                                       std::span<const float> densities, const SteinerOptions& options,
                                       const Progress& progress) {
  SteinerCells cells;
  if (sites.empty()) return cells;
  Steps steps(progress, "steiner", kLoops);
  const Error stopped = stoppedOnRequest("placing Steiner cells");

  // 1. Rays, and the cells that they cross.
  if (!steps.advance()) return stopped;
  const SiteTree tree(sites, radii, mortonOrder(sites));
  const auto rayCount = static_cast<uint32_t>(std::clamp(sites.size() / kCellsPerRay, kLeastRays, kMostRays));
  const std::vector<WalkRay> rays = makeChoosingRays(sites, radii, tree, options, rayCount);
  std::vector<RayCells> walks(rays.size());
  steps.forAll(rays.size(), [&](size_t i) { walks[i] = RayCells(tree, sites, radii, densities, rays[i]); });
  if (steps.isStopped()) return stopped;
  cells.walkLengthBefore = meanLength(walks);
  // 2. Balls that fit where the rays are in empty space.
  const std::vector<EmptyBall> balls = findBalls(EmptyBallFinder(tree, sites, radii, options), rays, walks, steps);
  if (steps.isStopped()) return stopped;
  // 3. Those that make walks shorter.
  for (const EmptyBall& ball : chooseBalls(balls, rays, walks, steps)) {
    cells.sites.push_back(ball.site);
    cells.radii.push_back(ball.radius);
  }
  if (steps.isStopped()) return stopped;
  cells.walkLengthAfter = meanLength(walks);
  return cells;
}

}  // namespace froth
