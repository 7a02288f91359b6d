#include <algorithm>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "baker/synth/gallery_scene.h"
#include "baker/synth/synth.h"
#include "reference/image/metrics.h"
#include "reference/render/reference.h"
#include "tests/synth/foam_checks.h"

namespace froth {
namespace {

constexpr uint32_t kCells = 12000;

const Foam& smallGallery() {
  static const Foam foam = *synthesizeFoam({"gallery", kCells});
  return foam;
}

glm::dvec3 eyeOf(const View& view) {
  return {view.worldFromCamera[3], view.worldFromCamera[7], view.worldFromCamera[11]};
}

TEST(Gallery, HasAboutTheCellsAskedFor) {
  expectSound(smallGallery());
  EXPECT_LE(smallGallery().cellCount, kCells);
  EXPECT_GT(smallGallery().cellCount, 0.95 * kCells);
  EXPECT_EQ(smallGallery().detailCount, 8u);
  EXPECT_EQ(smallGallery().lobeCount, 8u);
}

TEST(Gallery, IsTheSameOnAnyNumberOfThreads) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_TRUE(haveSameBits(*synthesizeFoam({"gallery", kCells}), smallGallery()));
}

TEST(Gallery, RefusesFewerCellsThanItsThinPartsNeed) {
  const Result<Foam> foam = synthesizeFoam({"gallery", 500});
  ASSERT_FALSE(foam);
  EXPECT_EQ(foam.error().kind, ErrorKind::kUsage);
}

TEST(Gallery, StopsWhenAsked) {
  const Result<Foam> foam =
      synthesizeFoam({"gallery", kCells}, [](std::string_view, uint64_t done, uint64_t) { return done == 0; });
  ASSERT_FALSE(foam);
  EXPECT_EQ(foam.error().kind, ErrorKind::kCancelled);
}

TEST(Gallery, FoamLooksLikeTheTracedSceneWithoutHoles) {
  const ReferenceRenderer renderer(smallGallery());
  ReferenceOptions options;
  options.precision = Precision::kFloat;
  options.nearRatio = 0;  // cells this large may come near the camera
  for (const size_t v : {size_t{0}, size_t{5}, size_t{8}}) {
    const View view = resizeView(galleryCameras().views[v], 120, 80);
    const auto traced = traceGallery(view, 4);
    const auto foam = renderer.render(view, options);
    ASSERT_TRUE(traced && foam);
    const auto difference = compareImages(*traced, foam->colour);
    ASSERT_TRUE(difference);
    EXPECT_GT(difference->psnr, 21) << view.name;
    const auto& alpha = foam->alpha.values;
    const auto holes = std::count_if(alpha.begin(), alpha.end(), [](float a) { return a < 0.98f; });
    EXPECT_LT(holes, 0.005 * static_cast<double>(alpha.size())) << view.name;
  }
}

TEST(Gallery, ColoursOfGlossyCellsDependOnTheView) {
  const Foam& foam = smallGallery();
  size_t glossy = 0;
  for (size_t detail = 0; detail < foam.detailSites.size(); ++detail) {
    glossy += foam.lobeColours[detail * foam.lobeCount] != foam.lobeColours[detail * foam.lobeCount + 1];
  }
  EXPECT_GT(glossy, foam.detailSites.size() / 10);
  EXPECT_LT(glossy, foam.detailSites.size() * 9 / 10);
}

TEST(GalleryCameras, KeepTheirDistanceFromEverySurface) {
  const CameraSet cameras = galleryCameras();
  ASSERT_EQ(cameras.views.size(), 12u);
  ASSERT_GE(cameras.flight.size(), 8u);
  // Cells nearer than 4 radii are not drawn; at 200,000 cells the largest of the room have a radius of 5 cm.
  for (const View& view : cameras.views) EXPECT_GT(galleryScene().clearance(eyeOf(view), 1), 0.3) << view.name;
  for (size_t i = 0; i < cameras.flight.size(); ++i) {
    const glm::dvec3 from = eyeOf(cameras.flight[i]), to = eyeOf(cameras.flight[(i + 1) % cameras.flight.size()]);
    for (double t = 0; t < 1; t += 0.25) {
      EXPECT_GT(galleryScene().clearance(glm::mix(from, to, t), 1), 0.3) << cameras.flight[i].name;
    }
    EXPECT_LT(glm::length(to - from), 1.0) << "the loop jumps after " << cameras.flight[i].name;
  }
}

TEST(GalleryTracer, ConvergesAndRepeats) {
  const View view = resizeView(galleryCameras().views[1], 90, 60);
  const Image few = *traceGallery(view, 4), many = *traceGallery(view, 25);
  EXPECT_TRUE(haveSameBits(few.values, traceGallery(view, 4)->values));
  EXPECT_GT(compareImages(few, many)->psnr, 28);
  EXPECT_GT(*std::max_element(many.values.begin(), many.values.end()), 0.8f);
}

TEST(GalleryTracer, RefusesNoSamplesAndNoPixels) {
  View view = galleryCameras().views[0];
  EXPECT_EQ(traceGallery(view, 0).error().kind, ErrorKind::kUsage);
  view.width = 0;
  EXPECT_EQ(traceGallery(view, 1).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace froth
