#include "baker/steiner/steiner.h"

#include <algorithm>

#include "baker/steiner/choosing_rays.h"
#include "baker/steiner/empty_balls.h"

namespace froth {
namespace {

// Candidates grow with the cells: each layer of Steiner cells over a surface has a fixed share of the surface's cells.
constexpr size_t kLeastRays = 4096, kMostRays = 1 << 17;
constexpr size_t kCellsPerRay = 8;

}  // namespace

Result<SteinerCells> placeSteinerCells(std::span<const glm::vec3> sites, std::span<const float> radii,
                                       std::span<const float> densities, const SteinerOptions& options,
                                       const Progress& progress) {
  SteinerCells cells;
  if (sites.empty()) return cells;
  const auto isStopped = [&](uint64_t done) { return !report(progress, "steiner", done, 2); };
  const Error stopped = makeError(ErrorKind::kCancelled, "placing Steiner cells stopped on request");

  if (isStopped(0)) return stopped;
  const BallTree tree(sites, radii);
  const auto rayCount = static_cast<uint32_t>(std::clamp(sites.size() / kCellsPerRay, kLeastRays, kMostRays));
  const std::vector<WalkRay> rays = makeChoosingRays(sites, radii, tree, options, rayCount);
  std::vector<EmptyBall> balls = findEmptyBalls(tree, sites, radii, densities, rays, options);
  if (isStopped(1)) return stopped;
  balls = thinEmptyBalls(std::move(balls));
  for (const EmptyBall& ball : balls) {
    cells.sites.push_back(ball.site);
    cells.radii.push_back(ball.radius);
  }
  if (isStopped(2)) return stopped;
  return cells;
}

}  // namespace froth
