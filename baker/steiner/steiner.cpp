#include "baker/steiner/steiner.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "baker/steiner/choosing_rays.h"
#include "baker/steiner/empty_balls.h"
#include "baker/steiner/ray_cells.h"

namespace froth {
namespace {

// Candidates grow with the cells, to a limit that keeps the time of small bakes of large scenes down.
constexpr size_t kLeastRays = 4096, kMostRays = 16384;
constexpr size_t kCellsPerRay = 8;
constexpr size_t kJudges = 1024;  // rays on which the walks are measured
constexpr uint64_t kStages = 3;

std::vector<WalkRay> chooseJudges(const std::vector<WalkRay>& rays) {
  const size_t stride = std::max<size_t>(1, rays.size() / kJudges);
  std::vector<WalkRay> judges;
  for (size_t i = 0; i < rays.size(); i += stride) judges.push_back(rays[i]);
  return judges;
}

double meanLength(std::span<const RayCells> walks) {
  size_t sum = 0;
  for (const RayCells& walk : walks) sum += walk.count();
  return static_cast<double>(sum) / static_cast<double>(walks.size());
}

// How many cells the walks cross on average, without and with the balls.
void measureWalks(const BallTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                  std::span<const float> densities, std::span<const WalkRay> rays, SteinerCells& cells) {
  std::vector<RayCells> walks(rays.size());
  tbb::parallel_for(size_t{0}, rays.size(),
                    [&](size_t i) { walks[i] = RayCells(tree, sites, radii, densities, rays[i]); });
  cells.walkLengthBefore = meanLength(walks);
  tbb::parallel_for(size_t{0}, rays.size(), [&](size_t i) {
    for (size_t k = 0; k < cells.sites.size(); ++k) walks[i].add(lineOf(cells.sites[k], cells.radii[k], rays[i]));
  });
  cells.walkLengthAfter = meanLength(walks);
}

}  // namespace

Result<SteinerCells> placeSteinerCells(std::span<const glm::vec3> sites, std::span<const float> radii,
                                       std::span<const float> densities, const SteinerOptions& options,
                                       const Progress& progress) {
  SteinerCells cells;
  if (sites.empty()) return cells;
  const auto isStopped = [&](uint64_t done) { return !report(progress, "steiner", done, kStages); };
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
  measureWalks(tree, sites, radii, densities, chooseJudges(rays), cells);
  if (isStopped(kStages)) return stopped;
  return cells;
}

}  // namespace froth
