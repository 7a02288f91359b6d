// MergedInstances instances in one view, crossing each other: against the double reference that merges them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "reference/render/merged_foams.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
constexpr VkExtent2D kLargest{240, 160};
constexpr double kRecordsOfARay = 64;  // kRecords of shaders/gpu/hit_records.glsl

// Two shapes of asset; their cells lie in [-1, 1]^3 + (0, 0, 3).
const Foam& foamOf(uint32_t which) {
  static const Foam foams[] = {makeRandomFoam(400, 4, 2, 31), makeRandomFoam(250, 2, 0, 7)};
  return foams[which];
}

const ReferenceRenderer& referenceOf(uint32_t which) {
  static const ReferenceRenderer renderers[] = {ReferenceRenderer(foamOf(0)), ReferenceRenderer(foamOf(1))};
  return renderers[which];
}

View frontView() { return lookAt({0.7, -0.5, -1.4}, {0.1, 0.1, 3}, 150, 110, 0.35); }

// focal [pixels]
View withLens(View view, LensKind kind, double focal) {
  view.lens.kind = kind;
  view.fx = view.fy = focal;
  return view;
}

FrothInstanceInfo placementOf(const PlacedFoam& placed) {
  FrothInstanceInfo info{};
  for (int axis = 0; axis < 3; ++axis) {
    info.position[axis] = placed.position[axis];
    info.rotation[axis] = static_cast<float>(placed.rotation[axis]);
  }
  info.rotation[3] = static_cast<float>(placed.rotation.w);
  info.scale = static_cast<float>(placed.scale);
  return info;
}

// Two assets, an instance of each, and the reference of the same placements.
class MergedInstances : public testing::Test {
 protected:
  static FrothContext* context() {
    static FrothContext* const made = createCheckedContext(kLenses);
    return made;
  }

  void SetUp() override {
    for (uint32_t which = 0; which < 2; ++which) {
      stages_.push_back(std::make_unique<Stage>(bakeForTest(foamOf(which)), kLargest, context(), 0, kLenses));
      placed_.push_back({&referenceOf(which), {}, {1, 0, 0, 0}, 1});
    }
    // The second stands askew in the first.
    place(1, {0.3, 0.2, 0.6}, glm::normalize(glm::dquat(0.9, 0.1, 0.35, -0.1)), 0.75);
  }

  void place(uint32_t which, const glm::dvec3& position, const glm::dquat& rotation, double scale) {
    const glm::quat rounded(rotation);  // as the runtime gets it
    placed_[which] = {&referenceOf(which), position, glm::normalize(glm::dquat(rounded)), static_cast<float>(scale)};
    stages_[which]->place(placementOf(placed_[which]));
  }

  Frame draw(Method method, const View& view) { return stages_[0]->draw(method, view); }

  RenderedImages reference(const View& view, const Image* sceneDistance = nullptr) const {
    ReferenceOptions options;
    options.cutoff = 1e-3;
    options.nearRatio = options.nearDepth = 0;
    options.sceneDistance = sceneDistance;
    Result<RenderedImages> images = renderMerged(placed_, view, options);
    EXPECT_TRUE(images) << images.error().message;
    return *images;
  }

  void expectLikeReference(const View& view) {
    const RenderedImages expected = reference(view);
    const Frame raster = draw(Method::kRaster, view), walk = draw(Method::kWalk, view);
    const double pair = psnr(raster.colour, walk.colour);
    const double first = psnr(raster.colour, expected.colour), second = psnr(walk.colour, expected.colour);
    std::printf("[   PSNR   ] raster-walk %.1f dB, raster-reference %.1f dB, walk-reference %.1f dB\n", pair, first,
                second);
    EXPECT_GE(pair, 60);
    EXPECT_LE(overTwoSteps(raster.colour, walk.colour), 1e-4);
    EXPECT_GE(first, 55);
    EXPECT_GE(second, 55);
    EXPECT_GE(psnr(raster.alpha, expected.alpha), 55);
    EXPECT_GE(psnr(raster.normal, expected.normal), 50);
    EXPECT_GE(psnr(walk.normal, expected.normal), 50);
    expectDistances(raster.distance, expected.distance);
    expectDistances(walk.distance, expected.distance);
  }

  // A wall all around the eye.
  void expectWallStopsRays(float distance) {
    const View view = withLens(frontView(), LensKind::kFisheye, 150);
    const Image distances{view.width, view.height, 1, std::vector<float>(size_t{view.width} * view.height, distance)};
    FrothRenderInfo info = infoOf(view);
    Result<HostImage> wall = sharedHost().createImage(VK_FORMAT_R32_SFLOAT, {view.width, view.height});
    ASSERT_TRUE(wall);
    ASSERT_TRUE(sharedHost().writeImage(*wall, distances.values));
    info.sceneDepth = sharedHost().describeInput(*wall);
    const RenderedImages expected = reference(view, &distances);
    EXPECT_LT(psnr(expected.colour, reference(view).colour), 35);
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      EXPECT_GE(psnr(stages_[0]->draw(method, info, {view.width, view.height}).colour, expected.colour), 55);
    }
    sharedHost().destroyImage(*wall);
  }

  // But for a few pixels that stop at one cell or the next.
  void expectDistances(const Image& found, const Image& expected) {
    size_t wrong = 0;
    for (size_t i = 0; i < found.values.size(); ++i) {
      const float reference = expected.values[i] < 0 ? INFINITY : expected.values[i];
      const bool isSame = reference == found.values[i] || std::abs(reference - found.values[i]) <= 1e-3f * reference;
      wrong += !isSame;
    }
    EXPECT_LE(static_cast<double>(wrong), 2e-3 * static_cast<double>(found.values.size()));
  }

  std::vector<std::unique_ptr<Stage>> stages_;
  std::vector<PlacedFoam> placed_;
};

TEST_F(MergedInstances, CrossingFoamsAreDrawnAsTheReferenceMergesThem) { expectLikeReference(frontView()); }

TEST_F(MergedInstances, CrossingFoamsAreDrawnAsTheReferenceMergesThemFromWithin) {
  expectLikeReference(lookAt({0.2, 0.1, 2.9}, {0.5, 0.3, 4}, 150, 110, 0.6));
}

TEST_F(MergedInstances, ParallelRaysMergeToo) {
  expectLikeReference(withLens(frontView(), LensKind::kOrthographic, 45));
}

TEST_F(MergedInstances, AFisheyeMergesToo) {
  expectLikeReference(withLens(lookAt({0.1, -0.2, 2.2}, {0.1, 0.1, 3}, 150, 110, 0.35), LensKind::kFisheye, 40));
}

TEST_F(MergedInstances, AFarAndLargeFoamBehindANearAndSmallOneKeepsTheOrder) {
  place(0, {-30, 20, 70}, {1, 0, 0, 0}, 12);
  place(1, {0.1, 0, -0.5}, {1, 0, 0, 0}, 0.3);
  expectLikeReference(lookAt({0, 0, -2}, {0, 0, 3}, 150, 110, 0.5));
}

// Boxes of foams that stand behind each other do not meet: tiles draw one list behind the other. The nearer foam is the
// second, then the first; both look through the gaps of the nearer.
class OrderedInstances : public MergedInstances {
 protected:
  void SetUp() override {
    MergedInstances::SetUp();
    place(0, {0.2, 0.1, 3.5}, glm::normalize(glm::dquat(0.9, -0.1, 0.2, 0.1)), 1.3);
    place(1, {0.1, 0, 0}, glm::normalize(glm::dquat(0.95, 0.1, 0, 0.05)), 0.8);
  }
  static View fromTheSide() { return lookAt({1.6, -0.9, 10}, {0.1, 0.1, 3}, 150, 110, 0.6); }
};

TEST_F(OrderedInstances, AreDrawnAsTheReferenceMergesThem) { expectLikeReference(frontView()); }

TEST_F(OrderedInstances, AreDrawnAsTheReferenceMergesThemFromTheOtherSide) { expectLikeReference(fromTheSide()); }

TEST_F(OrderedInstances, TakeParallelRaysToo) {
  for (const View& view : {frontView(), fromTheSide()}) {
    expectLikeReference(withLens(view, LensKind::kOrthographic, 45));
  }
}

TEST_F(OrderedInstances, TakeAFisheyeToo) {
  expectLikeReference(withLens(lookAt({0.1, -0.2, 0.5}, {0.1, 0.1, 3}, 150, 110, 0.35), LensKind::kFisheye, 40));
}

TEST_F(OrderedInstances, TheScenesDepthStopsRaysInTheFartherOne) { expectWallStopsRays(8.5f); }

// Instances of one foam in place of those of the fixture.
class CopiesOfAFoam : public MergedInstances {
 protected:
  void putCopies(Foam foam, const std::vector<glm::dvec3>& positions) {
    foam_ = std::move(foam);
    renderer_ = std::make_unique<ReferenceRenderer>(foam_);
    const auto asset = bakeForTest(foam_);
    for (const auto& stage : stages_) {
      FrothInstanceInfo hidden{};
      hidden.mask = 2;
      stage->place(hidden);
    }
    placed_.clear();
    for (const glm::dvec3& position : positions) {
      placed_.push_back({renderer_.get(), position, {1, 0, 0, 0}, 1});
      copies_.push_back(std::make_unique<Stage>(asset, VkExtent2D{64, 48}, context(), 0, kLenses));
      copies_.back()->place(placementOf(placed_.back()));
    }
  }

  Frame drawCopies(Method method, const View& view) {
    FrothRenderInfo info = infoOf(view);
    info.mask = 1;
    return copies_[0]->draw(method, info, {view.width, view.height});
  }

  Foam foam_;
  std::unique_ptr<ReferenceRenderer> renderer_;
  std::vector<std::unique_ptr<Stage>> copies_;
};

// More cells than a workgroup gathers before its rays set out.
TEST_F(CopiesOfAFoam, OfThousandsOfCellsBehindAFewPixelsAreAllMet) {
  putCopies(makeRandomFoam(4000, 1, 0, 3), {{0, 0, 0}, {0.2, 0.1, 0.3}});
  const View view = lookAt({0.1, 0.2, -20}, {0.1, 0.1, 3}, 64, 48, 0.3);
  const RenderedImages expected = reference(view);
  EXPECT_GE(psnr(drawCopies(Method::kRaster, view).colour, expected.colour), 55);
  EXPECT_GE(psnr(drawCopies(Method::kWalk, view).colour, expected.colour), 55);
}

// So thin that no ray ends in it: it gains something in more cells than it may keep at once.
TEST_F(CopiesOfAFoam, AreMergedWhereARayKeepsNotAllThatItFinds) {
  Foam thin = makeRandomFoam(4000, 1, 0, 3);
  for (float& density : thin.densities) density *= 0.02f;
  std::vector<glm::dvec3> positions;
  for (int i = 0; i < 8; ++i) positions.push_back({0.05 * i, 0.03 * i, 0.07 * i});
  putCopies(thin, positions);
  const View view = lookAt({0.1, 0.2, 1}, {0.1, 0.1, 3}, 32, 24, 0.2);
  const RenderedImages expected = reference(view);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame found = drawCopies(method, view);
    const double perRay = static_cast<double>(found.status.work.colours) / (view.width * view.height);
    EXPECT_GT(perRay, kRecordsOfARay);
    EXPECT_GE(psnr(found.colour, expected.colour), 55);
    EXPECT_GE(psnr(found.normal, expected.normal), 50);
    expectDistances(found.distance, expected.distance);
  }
}

// What lies behind the eye is no part of a picture, whichever of the two it is.
TEST_F(MergedInstances, FoamsBehindTheEyeAreLeftOut) {
  place(0, {0, 0, 0}, {1, 0, 0, 0}, 1);
  place(1, {0.2, 0, -12}, {1, 0, 0, 0}, 1);
  expectLikeReference(lookAt({0.1, 0.1, -3}, {0, 0, 3}, 150, 110, 0.3));
  expectLikeReference(lookAt({0.1, 0.1, -3}, {0, 0, -9}, 150, 110, 0.3));
}

// A tile that one instance has for itself is drawn by the pass for one.
TEST_F(MergedInstances, FoamsBesideEachOtherLookAsIfDrawnAlone) {
  place(0, {-2.2, 0, 0}, {1, 0, 0, 0}, 1);
  place(1, {2.2, 0, 0}, {1, 0, 0, 0}, 1);
  const View view = lookAt({0, 0, -4}, {0, 0, 3}, 240, 160, 0.45);
  FrothRenderInfo info = infoOf(view);
  const Frame both = stages_[0]->draw(Method::kRaster, info, kLargest);
  for (uint32_t which = 0; which < 2; ++which) {
    FrothInstanceInfo other = placementOf(placed_[1 - which]);
    other.mask = 2;
    stages_[1 - which]->place(other);
    FrothInstanceInfo own = placementOf(placed_[which]);
    own.mask = 1;
    stages_[which]->place(own);
    info.mask = 1;
    const Frame alone = stages_[0]->draw(Method::kRaster, info, kLargest);
    EXPECT_GT(*std::max_element(alone.alpha.values.begin(), alone.alpha.values.end()), 0.5f);
    uint32_t differing = 0;
    const uint32_t begin = which == 0 ? 0 : 128, end = which == 0 ? 96 : 240;  // whole tiles of this side
    for (uint32_t y = 0; y < kLargest.height; ++y) {
      for (uint32_t x = begin; x < end; ++x) differing += both.colour.pixel(x, y)[1] != alone.colour.pixel(x, y)[1];
    }
    EXPECT_EQ(differing, 0u) << "instance " << which;
  }
}

// Steps of a walk, by which of two are seen: the first, the second, both.
class StepsThroughInstances : public MergedInstances {
 protected:
  struct Steps {
    double first, second, both;
  };

  Steps countSteps(const View& view) {
    for (uint32_t which = 0; which < 2; ++which) {
      FrothInstanceInfo info = placementOf(placed_[which]);
      info.mask = 1u << which;
      stages_[which]->place(info);
    }
    const auto count = [&](uint32_t mask) {
      FrothRenderInfo info = infoOf(view);
      info.mask = mask;
      const Frame frame = stages_[0]->draw(Method::kWalk, info, {view.width, view.height});
      return static_cast<double>(frame.status.work.steps);
    };
    const Steps steps{count(1), count(2), count(3)};
    std::printf("[  STEPS   ] first %.0f, second %.0f, both %.0f\n", steps.first, steps.second, steps.both);
    EXPECT_GE(psnr(draw(Method::kWalk, view).colour, reference(view).colour), 55);
    return steps;
  }
};

TEST_F(StepsThroughInstances, AreNotTakenInAFoamThatTheRayMisses) {
  place(0, {-1.4, 0, 0}, {1, 0, 0, 0}, 1);
  place(1, {1.4, 0, 0}, {1, 0, 0, 0}, 1);
  const Steps steps = countSteps(lookAt({0, 0, -4}, {0, 0, 3}, 96, 64, 0.35));
  EXPECT_LT(steps.both, 0.8 * (steps.first + steps.second));
}

TEST_F(StepsThroughInstances, AreNotTakenInAFoamBehindWhereTheRayEnds) {
  place(0, {0, 0, 0}, {1, 0, 0, 0}, 1);
  place(1, {0, 0, 20}, {1, 0, 0, 0}, 10);
  const View view = lookAt({0, 0, -4}, {0, 0, 3}, 96, 64, 0.02);
  const Steps steps = countSteps(view);
  EXPECT_LT(steps.both, 1.05 * steps.first);
  EXPECT_GT(steps.second, 0.2 * steps.first);
}

TEST_F(MergedInstances, TheScenesDepthStopsRaysInAllOfThem) { expectWallStopsRays(4.3f); }

// Sorting by cells would flip where foams cross; what changes from frame to frame must be what changes in the
// reference.
TEST_F(MergedInstances, NothingFlipsInAnOrbit) {
  constexpr int kFrames = 16;
  Image lastFound, lastExpected;
  for (int i = 0; i < kFrames; ++i) {
    const double angle = 0.01 * i;
    const View view =
        lookAt({0.2 + 4.2 * std::sin(angle), -0.5, 3 - 4.2 * std::cos(angle)}, {0.1, 0.1, 3}, 100, 80, 0.33);
    const Image found = draw(Method::kRaster, view).colour, expected = reference(view).colour;
    ASSERT_GE(psnr(found, expected), 55) << "frame " << i;
    for (size_t k = 0; i > 0 && k < found.values.size(); ++k) {
      const float change = std::abs(found.values[k] - lastFound.values[k]);
      const float due = std::abs(expected.values[k] - lastExpected.values[k]);
      ASSERT_LE(change, due + 0.02f) << "frame " << i << ", value " << k;
    }
    lastFound = found;
    lastExpected = expected;
  }
}

TEST_F(MergedInstances, DrawingTwiceGivesTheSameBits) {
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    EXPECT_EQ(draw(method, frontView()).colour.values, draw(method, frontView()).colour.values);
  }
}

TEST_F(MergedInstances, InstancesOfOneAssetShareItAndComeAndGo) {
  const View view = frontView();
  const Frame before = draw(Method::kRaster, view);
  {
    Stage third(bakeForTest(foamOf(1)), {8, 8}, context(), 0, kLenses);
    PlacedFoam placed{&referenceOf(1), {-0.6, -0.4, 0.2}, {1, 0, 0, 0}, 0.5};
    third.place(placementOf(placed));
    placed_.push_back(placed);
    EXPECT_GE(psnr(draw(Method::kRaster, view).colour, reference(view).colour), 55);
    EXPECT_GE(psnr(draw(Method::kWalk, view).colour, reference(view).colour), 55);
    placed_.pop_back();
  }
  EXPECT_EQ(draw(Method::kRaster, view).colour.values, before.colour.values);
}

}  // namespace
}  // namespace froth::test
