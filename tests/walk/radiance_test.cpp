// Colours of rays on the GPU against pictures of the raster and of the reference in double.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "reference/image/metrics.h"
#include "shaders/foam/colour.h"
#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/walk/walk_stage.h"

namespace froth::test {
namespace {

// Premultiplied linear colour and opacity, of the reference's display-coded colour.
Image linearOf(const RenderedImages& images) {
  Image result{images.colour.width, images.colour.height, 4, {}};
  for (size_t pixel = 0; pixel < images.alpha.values.size(); ++pixel) {
    const float alpha = images.alpha.values[pixel];
    const float* colour = &images.colour.values[3 * pixel];
    const glm::vec3 linear = foam::linearPremultiplied(glm::vec3(colour[0], colour[1], colour[2]), alpha);
    result.values.insert(result.values.end(), {linear.x, linear.y, linear.z, alpha});
  }
  return result;
}

class GpuRadiance : public testing::TestWithParam<FrothRayPreparation> {};

void print(const char* name, double psnr) { std::printf("%s: %.1f dB\n", name, psnr); }

// Returns how many cells a ray meets in the mean.
double expectPictures(const Foam& foam, const View& view, FrothRayPreparation prepared) {
  WalkStage stage;
  stage.place(stage.open(bakeForTest(foam), prepared));
  const Image rays = imageOf(stage.cast(cameraRays(view), FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  const FrothWalkStatus status = stage.status();
  std::printf("%.1f cells, %.1f cells met, %.1f detail sites per ray\n", double(status.cells) / double(status.rays),
              double(status.cellsMet) / double(status.rays), double(status.detailSites) / double(status.rays));
  const double toRaster = psnr(rays, stage.rasterize(view));
  const double toReference = psnr(rays, linearOf(renderReference(foam, view)));
  print("rays and raster", toRaster);
  print("rays and reference", toReference);
  EXPECT_GE(toRaster, 60);
  EXPECT_GE(toReference, 55);
  return double(status.cellsMet) / double(status.rays);
}

TEST_P(GpuRadiance, OfACamerasRaysIsThePictureOfARandomFoam) {
  expectPictures(makeRandomFoam(200, 4, 2, 3), lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 96, 64, 0.5), GetParam());
}

TEST_P(GpuRadiance, OfACamerasRaysIsThePictureOfAGallery) {
  static const Foam foam = synthesize("gallery", 5000);
  expectPictures(foam, resizeView(galleryCameras().views.at(0), 120, 80), GetParam());
}

// Colours are found of 16 cells at a time (kShownAtOnce of gpu/walk_stream.glsl). Without the others the picture has 38
// dB.
TEST_P(GpuRadiance, OfRaysThroughMoreCellsThanTheyShadeAtOnceIsThePicture) {
  Foam foam = makeRandomFoam(4000, 4, 2, 3);
  for (float& radius : foam.radii) radius = 0.1f + 0.1f * radius;
  for (float& density : foam.densities) density *= 0.05f;
  EXPECT_GT(expectPictures(foam, lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 48, 32, 0.2), GetParam()), 12);
}

// What a mirror shows, its rays seen from their apex, is the picture of the mirrored camera.
//
//      mirrored camera   .  apex
//                       / \  .
//     ---------------------------- mirror, from where the rays start
//                     /     \  .
//                  ( foam )
TEST_P(GpuRadiance, OfMirroredRaysIsThePictureOfTheMirroredCamera) {
  const Foam foam = makeRandomFoam(200, 4, 2, 3);
  const View view = lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 96, 64, 0.4);
  WalkStage stage;
  stage.place(stage.open(bakeForTest(foam), GetParam()));
  const glm::vec3 normal(0.3f, 0.2f, 0.9f);
  std::vector<FrothGpuRay> rays = cameraRays(view);
  for (FrothGpuRay& ray : rays) {
    const glm::vec3 direction(ray.direction[0], ray.direction[1], ray.direction[2]);
    ray.apex = 2.2f / glm::dot(normal, direction);
    for (int axis = 0; axis < 3; ++axis) ray.origin[axis] = ray.apex * direction[axis];
  }
  const Image mirrored = imageOf(stage.cast(rays, FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  const double toRaster = psnr(mirrored, stage.rasterize(view));
  print("mirrored rays and raster", toRaster);
  EXPECT_GE(toRaster, 60);
}

// Rays side by side in one cast: with base colours, and as they are seen.
TEST_P(GpuRadiance, OfBaseColoursIsThatOfAnAssetWithoutViewDependence) {
  const AssetContents contents = bakeForTest(makeRandomFoam(200, 4, 2, 3));
  const View view = lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 96, 64, 0.5);
  const auto castThrough = [&](uint32_t layers, uint32_t flags) {
    WalkStage stage;
    stage.place(stage.open(contents, GetParam(), layers));
    std::vector<FrothGpuRay> rays = cameraRays(view);
    for (size_t i = 0; i < rays.size(); i += 2) rays[i].flags = flags;
    return imageOf(stage.cast(rays, FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  };
  const Image whole = castThrough(3, 0), mixed = castThrough(3, FROTH_RAY_BASE_COLOURS), base = castThrough(2, 0);
  Image expected = whole;
  for (size_t i = 0; i < expected.values.size(); i += 8) {
    std::copy_n(base.values.begin() + static_cast<std::ptrdiff_t>(i), 4,
                expected.values.begin() + static_cast<std::ptrdiff_t>(i));
  }
  EXPECT_LE(compareImages(mixed, expected)->maxError, 1e-4);
  EXPECT_GE(compareImages(whole, expected)->maxError, 0.1) << "no view dependence to leave out";
}

INSTANTIATE_TEST_SUITE_P(Prepared, GpuRadiance, preparations(), nameOfPreparation);

}  // namespace
}  // namespace froth::test
