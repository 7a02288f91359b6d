#include "tests/reference/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/camera/view_pose.h"

namespace froth {

Foam foamOf(const std::vector<PlainCell>& cells) {
  Foam foam;
  foam.cellCount = static_cast<uint32_t>(cells.size());
  foam.detailCount = foam.lobeCount = 1;
  for (const PlainCell& cell : cells) {
    foam.sites.push_back(cell.site);
    foam.radii.push_back(cell.radius);
    foam.densities.push_back(cell.density);
    foam.orientations.push_back(cell.orientation);
    foam.detailSites.emplace_back(0, 0);
    foam.detailHeights.push_back(cell.height);
    foam.lobeAxes.emplace_back(1, 0, 0);
    foam.lobeColours.push_back(cell.colour - 0.5f);
  }
  return foam;
}

Foam randomFoam(uint32_t cellCount, uint32_t detailCount, uint32_t lobeCount, uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  const auto vector = [&](float extent) {
    const float x = uniform(-extent, extent), y = uniform(-extent, extent);
    return glm::vec3(x, y, uniform(-extent, extent));
  };
  Foam foam;
  foam.cellCount = cellCount;
  foam.detailCount = detailCount;
  foam.lobeCount = lobeCount;
  for (uint32_t i = 0; i < cellCount; ++i) {
    foam.sites.push_back(glm::round(vector(1) * 16.0f) / 16.0f);
    foam.radii.push_back(uniform(0.15f, 0.6f));
    foam.densities.push_back(i % 10 == 9 ? 0.0f : uniform(0.5f, 20));
    const glm::vec3 axis = vector(1);
    foam.orientations.push_back(glm::normalize(glm::vec4(uniform(-1, 1), axis)));
  }
  for (uint32_t s = 0; s < cellCount * detailCount; ++s) {
    const float u = uniform(-0.8f, 0.8f);
    foam.detailSites.emplace_back(u, uniform(-0.8f, 0.8f));
    foam.detailHeights.push_back(uniform(-0.3f, 0.3f));
  }
  for (uint32_t l = 0; l < cellCount * detailCount * lobeCount; ++l) {
    foam.lobeAxes.push_back(vector(6));
    foam.lobeColours.push_back(vector(0.6f));
  }
  return foam;
}

Foam permuteFoam(const Foam& foam, const std::vector<uint32_t>& order) {
  Foam result = foam;
  const auto permute = [&](auto& target, const auto& source, size_t perCell) {
    for (size_t k = 0; k < order.size(); ++k) {
      for (size_t i = 0; i < perCell; ++i) target[k * perCell + i] = source[order[k] * perCell + i];
    }
  };
  permute(result.sites, foam.sites, 1);
  permute(result.radii, foam.radii, 1);
  permute(result.densities, foam.densities, 1);
  permute(result.orientations, foam.orientations, 1);
  permute(result.detailSites, foam.detailSites, foam.detailCount);
  permute(result.detailHeights, foam.detailHeights, foam.detailCount);
  permute(result.lobeAxes, foam.lobeAxes, size_t{foam.detailCount} * foam.lobeCount);
  permute(result.lobeColours, foam.lobeColours, size_t{foam.detailCount} * foam.lobeCount);
  return result;
}

View lookAt(const glm::dvec3& eye, const glm::dvec3& target, uint32_t width, uint32_t height, double tanHalfFov) {
  View view;
  setPose(view, eye, glm::normalize(target - eye), {0, -1, 0});
  view.width = width;
  view.height = height;
  view.fx = view.fy = height / (2 * tanHalfFov);
  view.cx = width / 2.0;
  view.cy = height / 2.0;
  return view;
}

glm::dvec3 directionOf(const View& view, uint32_t x, uint32_t y) {
  const double local[3] = {(x + 0.5 - view.cx) / view.fx, (y + 0.5 - view.cy) / view.fy, 1};
  glm::dvec3 world(0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) world[row] += view.worldFromCamera[4 * row + column] * local[column];
  }
  return glm::normalize(world);
}

ReferenceOptions plainOptions(Precision precision) {
  ReferenceOptions options;
  options.precision = precision;
  options.nearRatio = 0;
  return options;
}

RenderedImages renderFoam(const Foam& foam, const View& view, const ReferenceOptions& options) {
  Result<RenderedImages> images = ReferenceRenderer(foam).render(view, options);
  if (images) return std::move(*images);
  ADD_FAILURE() << images.error().message;
  return {};
}

void expectSameImages(const RenderedImages& a, const RenderedImages& b) {
  EXPECT_EQ(a.colour.values, b.colour.values);
  EXPECT_EQ(a.alpha.values, b.alpha.values);
  EXPECT_EQ(a.distance.values, b.distance.values);
  EXPECT_EQ(a.normal.values, b.normal.values);
}

}  // namespace froth
