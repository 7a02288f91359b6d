// Shadows and ambient occlusion of the foam on meshes against brute force on the CPU.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tests/room/reference_frame.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

struct Comparison {
  double meanError = 0, worst = 0;
  uint32_t pixels = 0, dimmed = 0;  // those compared, and those of them that the foam takes light from
};

// Over the places of matt and glossy meshes that pixels see; expected() of NaN: not compared.
Comparison compare(
    RoomUnderTest& room, const HostImage& image,
    const std::function<double(const glm::dvec3&, const glm::dvec3&, uint32_t x, uint32_t y)>& expected) {
  const std::vector<float> texels = room.read(image);
  const RoomGeometry meshes(room.stage().room());
  Comparison comparison;
  for (uint32_t y = 0; y < kRoomExtent.height; ++y) {
    for (uint32_t x = 0; x < kRoomExtent.width; ++x) {
      const glm::dvec3 direction = pixelDirection(room.pose(), x, y);
      const std::optional<MeshHit> hit = meshes.cast(room.pose().eye, direction, 0, INFINITY);
      if (!hit || room.stage().room().materials[hit->material].kind == MaterialKind::kMirror) continue;
      const glm::dvec3 normal = glm::dot(hit->normal, direction) > 0 ? -hit->normal : hit->normal;
      const double wanted = expected(room.pose().eye + hit->distance * direction, normal, x, y);
      if (std::isnan(wanted)) continue;
      const double error = std::abs(texels[4 * (size_t{y} * kRoomExtent.width + x)] - wanted);
      comparison.meanError += error;
      comparison.worst = std::max(comparison.worst, error);
      ++comparison.pixels;
      if (wanted < 0.9) ++comparison.dimmed;
    }
  }
  comparison.meanError /= comparison.pixels;
  return comparison;
}

class FoamOnMeshes : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasSuitableDevice()) FROTH_SKIP() << "no suitable Vulkan device";
    room_ = std::make_unique<RoomUnderTest>(RoomLook{}, false);
    room_->draw();
    reference_ = std::make_unique<ReferenceFrame>(*room_, std::vector<Particle>());
  }
  std::unique_ptr<RoomUnderTest> room_;
  std::unique_ptr<ReferenceFrame> reference_;
};

TEST_F(FoamOnMeshes, CastsItsShadow) {
  const glm::dvec3 toSun = room_->stage().room().toSun;
  const RoomGeometry meshes(room_->stage().room());
  const auto brute = [&](const glm::dvec3& position, const glm::dvec3& normal, uint32_t, uint32_t) {
    if (glm::dot(normal, toSun) <= 0) return double{NAN};
    if (meshes.cast(position + 1e-5 * normal, toSun, 0, INFINITY)) return double{NAN};  // the shadow map's part
    return reference_->throughFoam(position, toSun, 0);
  };
  const Comparison found = compare(*room_, room_->stage().renderer().images().sunlight, brute);
  std::printf("shadow: mean error %.5f over %u places, %u in shadow\n", found.meanError, found.pixels, found.dimmed);
  EXPECT_GT(found.dimmed, 50u);
  EXPECT_LE(found.meanError, 0.01);
}

TEST_F(FoamOnMeshes, KeepsSurroundingLightAwayRayByRay) {
  const double reach = room_->stage().look().occlusionReach;
  const auto brute = [&](const glm::dvec3& position, const glm::dvec3& normal, uint32_t x, uint32_t y) {
    double sum = 0;
    for (uint32_t i = 0; i < room::kSurroundRays; ++i) {
      const uint32_t number = 16 * i + (x & 3) * 4 + (y & 3);
      sum += reference_->throughFoam(position,
                                     ReferenceFrame::spreadDirection(normal, number, 16 * room::kSurroundRays), reach);
    }
    return sum / room::kSurroundRays;
  };
  const Comparison found = compare(*room_, room_->stage().renderer().images().surround, brute);
  std::printf("occlusion: mean error %.5f over %u places, %u dimmed\n", found.meanError, found.pixels, found.dimmed);
  EXPECT_GT(found.dimmed, 50u);
  EXPECT_LE(found.meanError, 0.01);
}

}  // namespace
}  // namespace froth::test
