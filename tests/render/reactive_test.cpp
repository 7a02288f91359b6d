// The reactive mask tells which part of a pixel its motion does not explain: against closed forms in double over the
// quarters that the double reference finds.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "reference/camera/view_rays.h"
#include "reference/render/merged_foams.h"
#include "tests/render/motion_forms.h"
#include "tests/render/random_foam.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = kMotionWidth, kHeight = kMotionHeight;
constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
constexpr double kStep = 1.0 / 255;  // of the image
// A point that was a little beside this distance from the pixel's is found in float; 120 pixels give 1e-5 of one.
constexpr double kTolerance = 0.5 * kStep + 1e-3;

const Foam& foam() {
  static const Foam made = makeRandomFoam(400, 4, 2, 57);
  return made;
}

FrothContext* createReactiveContext() {
  FrothContextInfo info = checkedContextInfo(kLenses);
  info.reactiveImages = 1;
  FrothContext* created = nullptr;
  check(frothCreateContext(&info, &created), "frothCreateContext");
  return created;
}

FrothContext* context() {
  static FrothContext* const made = createReactiveContext();
  return made;
}

Stage& stage() {
  static Stage* const made =
      new Stage(bakeForTest(foam()), {kWidth, kHeight}, context(), 0, kLenses, true, 2, false, true);
  return *made;
}

void putAtRest() {
  stage().place({});
  stage().draw(Method::kRaster, lensView(LensKind::kPinhole));
}

// Where what stands at t along a ray was seen before; t < 0: the background.
glm::dvec2 placeBefore(const Moved& moved, const ViewRay& ray, double t) {
  const bool isParallel = moved.now.lens.kind == LensKind::kOrthographic;
  const glm::dvec3 start = eyeOf(moved.now) + ray.offset;
  if (t < 0) return pixelOf(moved.before, isParallel ? start : ray.direction, !isParallel);
  return pixelOf(moved.before, toWorld(moved.poseBefore, toAsset(moved.poseNow, start + t * ray.direction)), false);
}

// foams: how each moved. shown: distance and foam of each pixel's point.
template <class Shown>
Image expectedMask(const std::vector<Moved>& foams, const RenderedImages& reference, const Shown& shown) {
  const View& now = foams[0].now;
  const ViewRays rays(now);
  Image mask{kWidth, kHeight, 1, std::vector<float>(size_t{kWidth} * kHeight)};
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      const size_t pixel = size_t{y} * kWidth + x;
      const ViewRay ray = *rays.ofPixel(x, y);
      const auto [distance, foam] = shown(pixel);
      const glm::dvec2 place = placeBefore(foams[foam], ray, distance);
      double sum = 0;
      for (size_t i = 0; i < 4; ++i) {
        glm::dvec2 apart =
            placeBefore(foams[reference.quarterFoams[pixel][i]], ray, reference.quarters[pixel][i]) - place;
        if (now.lens.kind == LensKind::kEquirectangular) apart.x -= kWidth * std::round(apart.x / kWidth);
        sum += std::min(glm::length(apart), 1.0);
      }
      *mask.pixel(x, y) = static_cast<float>(0.25 * sum);
    }
  }
  return mask;
}

Image expectedMask(const Moved& moved, const RenderedImages& reference) {
  return expectedMask({moved}, reference,
                      [&](size_t pixel) { return std::pair(reference.distance.values[pixel], 0u); });
}

// All but a few pixels, at which the last place of a float decides whether a quarter, or the point, is reached.
void expectMask(const Image& found, const Image& expected, const std::string& what) {
  ASSERT_EQ(found.values.size(), expected.values.size());
  size_t differing = 0, partial = 0;
  double sum = 0, most = 0;
  for (size_t i = 0; i < expected.values.size(); ++i) {
    const double error = std::abs(double{found.values[i]} - expected.values[i]);
    differing += error > kTolerance;
    if (error <= kTolerance) most = std::max(most, error);
    partial += expected.values[i] > 0.05f && expected.values[i] < 0.95f;
    sum += expected.values[i];
  }
  const double quality = psnr(found, expected);
  std::printf("[ REACTIVE ] %s: mean %.3f, %.1f dB, %zu pixels differ, the others by up to %.4f\n", what.c_str(),
              sum / static_cast<double>(expected.values.size()), quality, differing, most);
  EXPECT_LE(differing, expected.values.size() / 500) << what;
  EXPECT_GT(quality, 45) << what;
  EXPECT_GT(partial, expected.values.size() / 100) << what << ": nothing is between 0 and 1";
}

std::string nameOf(const Moved& moved, Method method) {
  return "lens " + std::to_string(static_cast<int>(moved.now.lens.kind)) + " " + infoOf(method).name;
}

TEST(Reactive, IsThatOfTheReferenceForAMovingCamera) {
  putAtRest();
  for (const LensKind kind : kMotionLenses) {
    const Moved moved{lensView(kind), lensView(kind, {0.5, -0.45, 0.38}, {0.15, 0.05, 3})};
    const Image expected = expectedMask(moved, renderReference(foam(), moved.now, 1e-3));
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      const Frame frame = stage().draw(method, infoOf(moved), {kWidth, kHeight});
      expectMask(frame.reactive, expected, nameOf(moved, method));
    }
  }
}

RenderedImages mergedReference(const std::vector<PlacedFoam>& placed, const View& view) {
  ReferenceOptions options;
  options.cutoff = 1e-3;
  options.nearRatio = options.nearDepth = 0;
  Result<RenderedImages> images = renderMerged(placed, view, options);
  EXPECT_TRUE(images) << images.error().message;
  return *images;
}

PlacedFoam placedAt(const ReferenceRenderer& renderer, const Pose& pose) {
  return {&renderer, pose.position, pose.rotation, pose.scale};
}

TEST(Reactive, IsThatOfTheReferenceForAMovingInstance) {
  const ReferenceRenderer renderer(foam());
  for (const LensKind kind : {LensKind::kPinhole, LensKind::kOrthographic, LensKind::kFisheye}) {
    const Moved moved{lensView(kind), lensView(kind), kTurned, {}};
    const Image expected = expectedMask(moved, mergedReference({placedAt(renderer, kTurned)}, moved.now));
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      stage().place({});
      stage().draw(method, moved.before);
      stage().place(infoOf(kTurned));
      expectMask(stage().draw(method, infoOf(moved), {kWidth, kHeight}).reactive, expected, nameOf(moved, method));
    }
  }
  stage().place({});
}

// Two that cross each other and move apart. The quantile is the middle of a quarter, so that the reference knows whose
// the point is.
TEST(Reactive, IsThatOfTheReferenceWhereInstancesOverlap) {
  const Foam second = makeRandomFoam(250, 2, 0, 7);
  Stage other(bakeForTest(second), {kWidth, kHeight}, context(), 0, kLenses, true, 1, false);
  const Pose otherNow{{0.3, 0.2, 0.6}, {1, 0, 0, 0}, 0.75}, otherBefore{{0.33, 0.19, 0.6}, {1, 0, 0, 0}, 0.75};
  const View view = lensView(LensKind::kPinhole), before = lensView(LensKind::kPinhole, {0.55, -0.48, 0.34});
  const std::vector<Moved> foams = {{view, before, kTurned, {}}, {view, before, otherNow, otherBefore}};
  const ReferenceRenderer first(foam()), renderer(second);
  const RenderedImages reference = mergedReference({placedAt(first, kTurned), placedAt(renderer, otherNow)}, view);
  const Image expected = expectedMask(foams, reference, [&](size_t pixel) {
    return std::pair(reference.quarters[pixel][1], reference.quarterFoams[pixel][1]);
  });
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    stage().place({});
    other.place(infoOf(otherBefore));
    stage().draw(method, before);
    stage().place(infoOf(kTurned));
    other.place(infoOf(otherNow));
    FrothRenderInfo info = infoOf(foams[0]);
    info.quantile = 0.625f;
    expectMask(stage().draw(method, info, {kWidth, kHeight}).reactive, expected, nameOf(foams[0], method));
  }
  stage().place({});
}

// However translucent: what does not move, or moves as one, is explained.
TEST(Reactive, IsZeroWhereNothingMovesAndWhereTheCameraTurns) {
  putAtRest();
  for (const LensKind kind : kMotionLenses) {
    const View view = lensView(kind);
    std::vector<View> befores = {view, lensView(kind, {0.6, -0.5, 0.3}, {0.15, 0.05, 3})};
    if (kind == LensKind::kOrthographic) befores.pop_back();  // parallel rays see a turn as a movement
    for (const View& before : befores) {
      FrothRenderInfo info = infoOf(Moved{view, before});
      info.camera.jitter[0] = 0.25f;
      for (const Method method : {Method::kRaster, Method::kWalk}) {
        for (const float value : stage().draw(method, info, {kWidth, kHeight}).reactive.values) ASSERT_EQ(value, 0);
      }
    }
  }
}

TEST(Reactive, IsOneWithoutAFrameBefore) {
  putAtRest();
  const View view = lensView(LensKind::kPinhole);
  for (const float value : stage().draw(Method::kRaster, view).reactive.values) ASSERT_EQ(value, 1);
}

TEST(Reactive, OfAnEmptyViewIsZero) {
  putAtRest();
  FrothRenderInfo info =
      infoOf(Moved{lensView(LensKind::kPinhole), lensView(LensKind::kPinhole, {0.5, -0.45, 0.38}, {0.15, 0.05, 3})});
  FrothInstanceInfo hidden{};
  hidden.mask = 2;
  stage().place(hidden);
  info.mask = 1;
  for (const float value : stage().draw(Method::kRaster, info, {kWidth, kHeight}).reactive.values) ASSERT_EQ(value, 0);
  putAtRest();
}

// The eyes share what their quarters are kept in.
TEST(Reactive, OfTwoEyesInOneFrameIsThatOfEachAlone) {
  putAtRest();
  const auto infoOfEye = [](uint32_t eye) {
    const double shift = 0.1 * eye;
    FrothRenderInfo info = infoOf(Moved{lensView(LensKind::kPinhole, {0.6 + shift, -0.5, 0.3}),
                                        lensView(LensKind::kPinhole, {0.5 + shift, -0.45, 0.38})});
    info.eye = eye;
    return info;
  };
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    std::vector<HostImage> images;
    std::vector<std::pair<Method, FrothRenderInfo>> draws;
    for (uint32_t eye = 0; eye < 2; ++eye) {
      images.push_back(*sharedHost().createImage(VK_FORMAT_R8_UNORM, {kWidth, kHeight}));
      draws.emplace_back(method, infoOfEye(eye));
      draws.back().second.reactive = sharedHost().describe(images.back());
    }
    stage().submit(draws);
    std::vector<std::vector<float>> together;
    for (HostImage& image : images) {
      together.push_back(*sharedHost().readImage(image));
      sharedHost().destroyImage(image);
    }
    EXPECT_NE(together[0], together[1]);
    for (uint32_t eye = 0; eye < 2; ++eye) {
      EXPECT_EQ(together[eye], stage().draw(method, infoOfEye(eye), {kWidth, kHeight}).reactive.values);
    }
  }
}

TEST(Reactive, LeavesAllOtherImagesAsTheyAre) {
  putAtRest();
  FrothContext* const plain = createCheckedContext(0);
  {
    Stage other(bakeForTest(foam()), {kWidth, kHeight}, plain, 0, 0, true);
    const FrothRenderInfo info =
        infoOf(Moved{lensView(LensKind::kPinhole), lensView(LensKind::kPinhole, {0.5, -0.45, 0.38})});
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      const Frame with = stage().draw(method, info, {kWidth, kHeight});
      const Frame without = other.draw(method, info, {kWidth, kHeight});
      EXPECT_EQ(with.colour.values, without.colour.values);
      EXPECT_EQ(with.distance.values, without.distance.values);
      EXPECT_EQ(with.normal.values, without.normal.values);
      EXPECT_EQ(with.id, without.id);
      EXPECT_EQ(with.motion.values, without.motion.values);
    }
  }
  check(frothDestroyContext(plain, UINT64_MAX), "frothDestroyContext");
}

TEST(Reactive, TakesSixteenBytesPerPixelBesideTheHits) {
  const FrothViewStatus status = stage().submit({});
  const auto isHits = [](const FrothMemory& memory) { return std::string(memory.name) == "hits"; };
  const auto* end = status.memory + status.memoryCount;
  const auto* hits = std::find_if(status.memory, end, isHits);
  ASSERT_NE(hits, end);
  EXPECT_EQ(hits->bytes, uint64_t{kWidth} * kHeight * (12 + 16));
}

}  // namespace
}  // namespace froth::test
