#include "baker/steiner/choosing_rays.h"

#include <algorithm>

#include "base/counter_random.h"

namespace froth {
namespace {

constexpr uint32_t kRaysPerFreeRay = 4;  // for other places than those of the cameras

std::vector<WalkRay> makeFreeRays(std::span<const glm::vec3> sites, std::span<const float> radii, const SiteTree& tree,
                                  const SteinerOptions& options, uint32_t count) {
  constexpr float kLeavesBall = 1.01f;
  const CounterRandom eye(options.seed, Purpose::kEye), direction(options.seed, Purpose::kDirection);
  const glm::dvec3 low = tree.bounds().ballLow, size = glm::dvec3(tree.bounds().ballHigh) - low;
  std::vector<WalkRay> rays(count);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 away = direction.direction(i);
    if (i % 2 == 0) {
      const uint64_t cell = eye.bits(3 * i) % sites.size();
      rays[i].origin = sites[cell] + kLeavesBall * radii[cell] * away;
    } else {
      rays[i].origin = low + size * glm::dvec3(eye.uniform(3 * i), eye.uniform(3 * i + 1), eye.uniform(3 * i + 2));
    }
    rays[i].direction = rays[i].forward = away;
  }
  return rays;
}

}  // namespace

std::vector<WalkRay> makeChoosingRays(std::span<const glm::vec3> sites, std::span<const float> radii,
                                      const SiteTree& tree, const SteinerOptions& options, uint32_t count) {
  std::vector<View> views;
  if (options.cameras) {
    views = options.cameras->views;
    views.insert(views.end(), options.cameras->flight.begin(), options.cameras->flight.end());
  }
  if (views.empty()) return makeFreeRays(sites, radii, tree, options, count);
  const uint32_t freeCount = count / kRaysPerFreeRay;
  const auto raysPerView = static_cast<uint32_t>((count - freeCount) / views.size() + 1);
  std::vector<WalkRay> rays = raysOfViews(views, raysPerView, options.nearRatio, options.nearDepth, options.seed);
  const std::vector<WalkRay> free = makeFreeRays(sites, radii, tree, options, freeCount);
  rays.insert(rays.end(), free.begin(), free.end());
  return rays;
}

}  // namespace froth
