#include "trainer/cpu/view_exchange.h"

#include <tbb/parallel_for.h>

namespace froth {

std::vector<float> lensDirections(const View& view) {
  if (view.lens.kind == LensKind::kPinhole) return {};
  View atHome = view;  // its axes are the world's
  atHome.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  const ViewRays rays(atHome);
  std::vector<float> directions(size_t{3} * view.width * view.height);
  tbb::parallel_for(uint32_t{0}, view.height, [&](uint32_t y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const std::optional<ViewRay> ray = rays.ofPixel(x, y);
      const glm::vec3 direction = ray ? glm::vec3(ray->direction) : glm::vec3(0);
      for (glm::length_t axis = 0; axis < 3; ++axis) {
        directions[3 * (size_t{y} * view.width + x) + static_cast<size_t>(axis)] = direction[axis];
      }
    }
  });
  return directions;
}

}  // namespace froth
