// The first foam, from points and without, from captures that are odd.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <tbb/global_control.h>

#include "base/float_span.h"
#include "foam/foam_arrays.h"
#include "foam/morton_order.h"
#include "reference/camera/view_points.h"
#include "reference/camera/view_rays.h"
#include "tests/trainer_input/capture_sample.h"
#include "trainer/start/nearest_sites.h"
#include "trainer/start/spread_points.h"
#include "trainer/start/start_foam.h"

namespace froth {
namespace {

StartFoam startOf(const Capture& capture, const StartOptions& options, std::span<const Photo> photos = {},
                  uint64_t seed = 1) {
  const std::vector<uint32_t> training = test::allViews(capture);
  const SceneFrame frame = findSceneFrame(capture);
  Result<StartFoam> start = makeStartFoam({capture, frame, training, photos, seed, findEyes(capture, frame)}, options);
  if (start) return std::move(*start);
  ADD_FAILURE() << start.error().message;
  return {};
}

// Every number is finite, counts fit, radii are positive, orientations of unit length.
void expectSound(const Foam& foam, const StartOptions& options) {
  EXPECT_EQ(foam.cellCount, options.cellCount);
  const size_t cells = foam.cellCount, details = cells * options.detailCount, lobes = details * options.lobeCount;
  visitArrays([&](const FoamArray& array, auto values) {
    if (array.canBeEmpty) return;
    const size_t count = array.index == FoamIndex::kCell ? cells : array.index == FoamIndex::kLobe ? lobes : details;
    EXPECT_EQ((foam.*values).size(), count) << array.name;
    const std::span<const float> numbers = floatsOf(foam.*values);
    EXPECT_TRUE(std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); })) << array.name;
  });
  EXPECT_TRUE(std::all_of(foam.radii.begin(), foam.radii.end(), [](float r) { return r > 0; }));
  for (const glm::vec4& orientation : foam.orientations) EXPECT_NEAR(glm::length(orientation), 1, 1e-5);
}

// Share of the cells that some view shows.
double shareSeen(const Foam& foam, const Capture& capture) {
  const SceneFrame frame = findSceneFrame(capture);
  std::vector<View> views;
  for (const CapturedView& view : capture.views) views.push_back(normalised(view.view, frame));
  const auto isSeen = [&](const glm::vec3& site) {
    return std::any_of(views.begin(), views.end(),
                       [&](const View& view) { return ViewPoints(view).of(glm::dvec3(site)).has_value(); });
  };
  return double(std::count_if(foam.sites.begin(), foam.sites.end(), isSeen)) / double(foam.sites.size());
}

void letOneViewObserve(Capture& capture, uint32_t view) {
  for (CapturedPoint& point : capture.points) {
    point.firstObserver = view;
    point.observerCount = 1;
  }
}

constexpr StartOptions kSmall{500, 2, 3};

TEST(StartFoam, CellsStandOnPointsAndFaceWhoSawThem) {
  Capture capture = test::orbit(8, {10, 0, 0}, 20);
  test::addPoints(capture, 2000, {10, 0, 0}, 3);
  letOneViewObserve(capture, 2);
  const StartFoam start = startOf(capture, kSmall);
  expectSound(start.foam, kSmall);
  EXPECT_EQ(start.points, 500u);
  const SceneFrame frame = findSceneFrame(capture);
  const glm::dvec3 eye = normalised(eyeOf(capture.views[2].view), frame);
  for (uint32_t i = 0; i < 500; ++i) {
    const glm::dvec3 normal = faceFrame<double>(start.foam.orientations[i]).normal;
    EXPECT_GT(glm::dot(normal, glm::normalize(eye - glm::dvec3(start.foam.sites[i]))), 0.9999);
    EXPECT_LE(start.foam.radii[i], 0.0501 * 48 / 60 * glm::distance(eye, glm::dvec3(start.foam.sites[i])));
  }
  EXPECT_NEAR(start.foam.lobeColours[0].y, 100 / 255.0 - 0.5, 1e-6);
  EXPECT_EQ(start.foam.lobeColours[0], start.foam.lobeColours[5]);
}

TEST(StartFoam, BallsAreSmallBeforeEachViewThatHasThemInItsImage) {
  Capture capture = test::orbit(8, {0, 0, 0}, 4);
  test::addPoints(capture, 300, {0, 0, 0}, 1);
  letOneViewObserve(capture, 2);
  capture.views.push_back(test::viewFrom({0, 0, 1.5}, {0, 0, 0}, "near"));  // nobody says that it sees them
  const SceneFrame frame = findSceneFrame(capture);
  const Foam foam = startOf(capture, kSmall).foam;
  const View near = normalised(capture.views.back().view, frame);
  const ViewPoints image(near);
  uint32_t inImage = 0;
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    if (!image.of(glm::dvec3(foam.sites[i]))) continue;
    ++inImage;
    const double distance = glm::distance(eyeOf(near), glm::dvec3(foam.sites[i]));
    EXPECT_LE(foam.radii[i], std::max(1.001e-4, 0.0501 * near.height / near.fy * distance));
  }
  EXPECT_GT(inImage, 100u);
}

// As the nearest view sees it that has it in its image.
TEST(StartFoam, PointsThatNobodyObservedFaceTheNearestView) {
  Capture capture = test::orbit(8, {0, 0, 0}, 4);
  test::addPoints(capture, 600, {0, 0, 0}, 0.5);
  for (CapturedPoint& point : capture.points) point.observerCount = 0;
  const SceneFrame frame = findSceneFrame(capture);
  const Foam foam = startOf(capture, kSmall).foam;
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const glm::dvec3 site(foam.sites[i]);
    glm::dvec3 nearest(HUGE_VAL);
    for (const CapturedView& view : capture.views) {
      const glm::dvec3 eye = normalised(eyeOf(view.view), frame);
      if (glm::distance(eye, site) < glm::distance(nearest, site)) nearest = eye;
    }
    const glm::dvec3 normal = faceFrame<double>(foam.orientations[i]).normal;
    EXPECT_GT(glm::dot(normal, glm::normalize(nearest - site)), 0.9999);
    EXPECT_LE(foam.radii[i], 0.0501 * 48 / 60 * glm::distance(nearest, site));
  }
}

// So that a ball far away is as transparent as it looks.
TEST(StartFoam, DensitiesFallWithTheUnit) {
  Capture capture = test::orbit(8, {0, 0, 0}, 4);
  test::addPoints(capture, 2000, {0, 0, 0}, 1);
  for (size_t i = 0; i < 400; ++i) capture.points[i].position *= 500.0;
  const SceneFrame frame = findSceneFrame(capture);
  const Eyes eyes = findEyes(capture, frame);
  const Foam foam = startOf(capture, kSmall).foam;
  uint32_t far = 0;
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const double unit = std::max(1.0, (glm::distance(foam.sites[i], eyes.centre) - eyes.radius) / 4.0);
    EXPECT_NEAR(foam.densities[i] * unit, 0.1, 1e-3);
    far += unit > 10;
  }
  EXPECT_GT(far, 20u);
}

TEST(StartFoam, FewPointsAreMixedAndThenTheFrustaAreFilled) {
  Capture capture = test::orbit(8, {0, 0, 0}, 4);
  test::addPoints(capture, 20, {0, 0, 0}, 1);
  const StartFoam start = startOf(capture, kSmall);
  expectSound(start.foam, kSmall);
  EXPECT_EQ(start.points, 19u);
  EXPECT_EQ(start.mixtures, 180u);
  EXPECT_EQ(start.random, 301u);
  EXPECT_GE(std::ranges::count_if(start.foam.sites, [](const glm::vec3& site) { return glm::length(site) < 3; }), 199);
  EXPECT_EQ(shareSeen(start.foam, capture), 1);
}

TEST(StartFoam, CellsLieAlongACurve) {
  Capture capture = test::orbit(8, {0, 0, 0}, 4);
  test::addPoints(capture, 200, {0, 0, 0}, 1);
  const std::vector<uint32_t> order = mortonOrder(startOf(capture, kSmall).foam.sites);
  EXPECT_TRUE(std::ranges::is_sorted(order));
}

TEST(StartFoam, TheSameSeedGivesTheSameBitsOnAnyNumberOfThreads) {
  Capture capture = test::orbit(8, {0, 0, 0}, 4);
  test::addPoints(capture, 40, {0, 0, 0}, 1);
  const StartFoam many = startOf(capture, kSmall), other = startOf(capture, kSmall, {}, 2);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
  const StartFoam one = startOf(capture, kSmall);
  visitArrays([&](const FoamArray& array, auto values) {
    EXPECT_TRUE(
        std::ranges::equal(std::as_bytes(floatsOf(many.foam.*values)), std::as_bytes(floatsOf(one.foam.*values))))
        << array.name;
  });
  EXPECT_NE(many.foam.sites, other.foam.sites);
}

TEST(StartFoam, OddCapturesStart) {
  const Capture around = test::orbit(8, {0, 0, 0}, 4);
  Capture coincident = around;
  test::addPoints(coincident, 400, {0, 0, 0}, 0);
  Capture far = around;
  test::addPoints(far, 400, {0, 0, 0}, 1);
  for (uint32_t i = 0; i < 30; ++i) far.points[i].position = glm::dvec3(1e9 * (i + 1), -1e12, 3);
  Capture turned;
  for (int i = 0; i < 8; ++i) {
    turned.views.push_back(test::viewFrom({1, 2, 3}, {1 + std::cos(i * 0.785), 2, 3 + std::sin(i * 0.785)}, "a"));
  }
  Capture narrow = around;
  for (CapturedView& view : narrow.views) view.view.fx = view.view.fy = 6000;
  Capture twoEyes = test::orbit(2, {0, 0, 0}, 4);
  test::addPoints(twoEyes, 1, eyeOf(twoEyes.views[0].view), 0);  // in an eye
  for (const Capture* capture :
       std::initializer_list<const Capture*>{&around, &coincident, &far, &turned, &narrow, &twoEyes}) {
    const StartFoam start = startOf(*capture, kSmall);
    expectSound(start.foam, kSmall);
    EXPECT_GT(shareSeen(start.foam, *capture), 0.5);
    for (const glm::vec3& site : start.foam.sites) ASSERT_LT(glm::length(site), 1000);
    std::vector<glm::vec3> sites = start.foam.sites;
    std::sort(sites.begin(), sites.end(),
              [](const glm::vec3& a, const glm::vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    EXPECT_EQ(std::adjacent_find(sites.begin(), sites.end()), sites.end());  // no two cells share a site
  }
  EXPECT_EQ(startOf(far, kSmall).points, uint32_t(0.95 * 370));
}

TEST(StartFoam, RandomCellsFillTheVisualHull) {
  const Capture capture = test::orbit(16, {0, 0, 0}, 4);
  std::vector<Photo> photos;
  for (const CapturedView& view : capture.views) {
    Photo photo{view.view, std::vector<uint8_t>(size_t{4} * 64 * 48), {}};
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        const bool isObject = std::hypot(x - 31.5, y - 23.5) < 8;  // a ball of radius 0.53
        uint8_t* rgba = &photo.rgba[4 * size_t(y * 64 + x)];
        if (isObject) std::fill_n(rgba, 4, uint8_t{255});
        if (isObject) rgba[0] = 51;
      }
    }
    photos.push_back(std::move(photo));
  }
  const StartFoam start = startOf(capture, kSmall, photos);
  expectSound(start.foam, kSmall);
  uint32_t inside = 0;
  for (const glm::vec3& site : start.foam.sites) inside += glm::length(site) < 0.7f;
  EXPECT_GT(inside, 400u);  // random depths alone: 69; the hull is a little larger than the ball, and tries end
  EXPECT_NEAR(start.foam.lobeColours[0].x, 51 / 255.0 - 0.5, 1e-6);
  EXPECT_NEAR(start.foam.lobeColours[0].y, 0.5, 1e-6);
}

// Rays through samples of all views that meet no ball.
uint32_t countMisses(const Foam& foam, const Capture& capture) {
  const SceneFrame frame = findSceneFrame(capture);
  uint32_t misses = 0;
  for (const CapturedView& captured : capture.views) {
    const View view = normalised(captured.view, frame);
    const ViewRays rays(view);
    for (uint32_t sample = 0; sample < 64 * 48; sample += 13) {
      const ViewRay ray = *rays.ofPixel(sample % 64, sample / 64);
      const auto isMet = [&](size_t cell) {
        const glm::dvec3 offset = glm::dvec3(foam.sites[cell]) - eyeOf(view);
        const double along = glm::dot(offset, ray.direction), radius = foam.radii[cell];
        return along > 0 && glm::dot(offset, offset) - along * along < radius * radius;
      };
      bool meets = false;
      for (size_t cell = 0; cell < foam.sites.size() && !meets; ++cell) meets = isMet(cell);
      misses += !meets;
    }
  }
  return misses;
}

TEST(StartFoam, CellsCoverWhatPhotosShowAndPointsDoNot) {
  constexpr StartOptions kCovering{1600, 1, 1};
  Capture capture = test::orbit(4, {0, 0, 0}, 4);
  test::addPoints(capture, 2000, {0, 0, 0}, 0.3);  // in the middle of each image
  std::vector<Photo> photos;
  for (const CapturedView& view : capture.views) {
    photos.push_back({view.view, std::vector<uint8_t>(size_t{4} * 64 * 48, 255), {}});
  }
  const StartFoam bare = startOf(capture, kCovering), covered = startOf(capture, kCovering, photos);
  expectSound(covered.foam, kCovering);
  EXPECT_EQ(bare.gaps, 0u);
  EXPECT_GT(countMisses(bare.foam, capture), 600u);  // of 948 samples
  EXPECT_GT(covered.gaps, 100u);
  EXPECT_LE(covered.gaps, 400u);
  EXPECT_LT(countMisses(covered.foam, capture), 30u);  // between samples of the lattice
  EXPECT_EQ(covered.foam.lobeColours[1599], glm::vec3(0.5f));

  for (Photo& photo : photos) photo.counted.assign(size_t{64} * 48, 0);
  EXPECT_EQ(startOf(capture, kCovering, photos).gaps, 0u);
  for (Photo& photo : photos) {
    photo.counted.clear();
    std::fill(photo.rgba.begin(), photo.rgba.end(), uint8_t{0});
  }
  EXPECT_EQ(startOf(capture, kCovering, photos).gaps, 0u);
}

TEST(StartFoam, BadCountsAreRefused) {
  const Capture capture = test::orbit(8, {0, 0, 0}, 4);
  const std::vector<uint32_t> training = test::allViews(capture);
  for (const StartOptions& options : {StartOptions{0, 8, 8}, StartOptions{10, 0, 8}, StartOptions{10, 8, 33}}) {
    EXPECT_FALSE(makeStartFoam({capture, {}, training, {}, 1}, options));
  }
  EXPECT_FALSE(makeStartFoam({capture, {}, {}, {}, 1}, kSmall));
}

TEST(SpreadOrder, BeginningsCoverAllAndCoincidentPointsCountOnce) {
  const CounterRandom random(3, Purpose::kSite);
  std::vector<glm::dvec3> points;
  for (uint32_t i = 0; i < 4000; ++i) {  // nine tenths in a corner
    const double side = i % 10 == 0 ? 8 : 0.5;
    points.push_back(side * glm::dvec3(random.uniform(3 * i), random.uniform(3 * i + 1), random.uniform(3 * i + 2)));
  }
  for (int i = 0; i < 50; ++i) points.push_back(points[7]);
  points.push_back({2000, 0, 0});
  const std::vector<uint32_t> order = spreadOrder(points, 1000, 1);
  EXPECT_EQ(order.size(), 4000u);
  double farthest = 0;
  for (uint32_t i = 0; i < 4000; ++i) {
    double nearest = 1e9;
    for (uint32_t k = 0; k < 200; ++k) nearest = std::min(nearest, glm::distance(points[i], points[order[k]]));
    farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(farthest, 3.5);  // 64 cubes of side 2 have a point each: less than their diagonal
}

TEST(NearestSites, AreThoseOfBruteForce) {
  const CounterRandom random(4, Purpose::kSite);
  std::vector<glm::vec3> sites;
  for (uint32_t i = 0; i < 300; ++i) sites.push_back(glm::vec3(random.direction(i)) * (i % 3 == 0 ? 0.01f : 1.0f));
  sites[5] = sites[6];
  const std::vector<float> radii(sites.size(), 0.0f);
  std::vector<uint32_t> members(sites.size());
  std::iota(members.begin(), members.end(), 0u);
  const SiteTree tree(sites, radii, members);
  for (uint32_t i = 0; i < 20; ++i) {
    const glm::dvec3 place(sites[i]);
    std::sort(members.begin(), members.end(), [&](uint32_t a, uint32_t b) {
      const glm::dvec3 u = glm::dvec3(sites[a]) - place, v = glm::dvec3(sites[b]) - place;
      return std::make_tuple(glm::dot(u, u), a) < std::make_tuple(glm::dot(v, v), b);
    });
    const std::vector<NearSite> nearest = findNearestSites(tree, sites, place, 8);
    ASSERT_EQ(nearest.size(), 8u);
    for (uint32_t k = 0; k < 8; ++k) EXPECT_EQ(nearest[k].site, members[k]);
  }
}

}  // namespace
}  // namespace froth
