#include "trainer/cpu/view_exchange.h"

namespace froth {

std::vector<float> lensDirections(const View& view) {
  if (view.lens.kind == LensKind::kPinhole) return {};
  View atHome = view;  // its axes are the world's
  atHome.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  const ViewRays rays(atHome);
  std::vector<float> directions;
  directions.reserve(size_t{3} * view.width * view.height);
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const std::optional<ViewRay> ray = rays.ofPixel(x, y);
      const glm::vec3 direction = ray ? glm::vec3(ray->direction) : glm::vec3(0);
      directions.insert(directions.end(), {direction.x, direction.y, direction.z});
    }
  }
  return directions;
}

}  // namespace froth
