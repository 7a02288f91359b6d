// Raster and walk against the double reference renderer on the small named scenes.
#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

Foam makeFoam(const char* name, uint32_t cells = 0) {
  Result<Foam> foam = synthesizeFoam({name, cells, 1});
  EXPECT_TRUE(foam) << foam.error().message;
  return *foam;
}

constexpr uint32_t kWidth = 160, kHeight = 120;

class SmallScene : public testing::TestWithParam<const char*> {};

TEST_P(SmallScene, IsDrawnAsTheReferenceDrawsItByRasterAndWalk) {
  const Foam foam = makeFoam(GetParam());
  const View view = lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, kWidth, kHeight, 0.6);
  const RenderedImages expected = renderReference(foam, view);
  Stage stage(bakeForTest(foam), {kWidth, kHeight});
  const Frame raster = stage.draw(Method::kRaster, view);
  const Frame walk = stage.draw(Method::kWalk, view);
  RecordProperty("raster", std::to_string(psnr(raster.colour, expected.colour)));
  std::printf("%s: raster %.1f walk %.1f walk-raster %.1f alpha %.1f normal %.1f\n", GetParam(), psnr(raster.colour, expected.colour), psnr(walk.colour, expected.colour), psnr(walk.colour, raster.colour), psnr(raster.alpha, expected.alpha), psnr(raster.normal, expected.normal));
  for (uint32_t i = 0; i < raster.status.passCount; ++i) std::printf("  %s %.2f\n", raster.status.passes[i].name, raster.status.passes[i].milliseconds);
  for (uint32_t i = 0; i < walk.status.passCount; ++i) std::printf("  %s %.2f\n", walk.status.passes[i].name, walk.status.passes[i].milliseconds);
  std::printf("  visible %u pairs %lu steps %lu\n", raster.status.visibleCells, raster.status.pairs, walk.status.walkSteps);
  EXPECT_GE(psnr(raster.colour, expected.colour), 60);
  EXPECT_GE(psnr(raster.alpha, expected.alpha), 60);
  EXPECT_GE(psnr(raster.normal, expected.normal), 60);
  EXPECT_GE(psnr(walk.colour, raster.colour), 60);
  EXPECT_LE(overTwoSteps(walk.colour, raster.colour), 1e-4);
  EXPECT_EQ(walk.status.bits, 0u);
}

INSTANTIATE_TEST_SUITE_P(Named, SmallScene, testing::Values("one", "two", "grid", "shell", "random"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace froth::test
