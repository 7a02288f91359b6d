// Foams of one and two cells, whose images can be written down.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "tests/reference/scenes.h"

namespace froth {
namespace {

struct Chord {
  double tNear, tFar;
  double length() const { return std::max(tFar - tNear, 0.0); }
};

// The textbook way; empty when missed.
Chord chordOf(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& centre, double radius) {
  const double b = glm::dot(direction, centre - eye), c = glm::dot(centre - eye, centre - eye) - radius * radius;
  if (b * b < c) return {0, 0};
  return {std::max(b - std::sqrt(b * b - c), 0.0), std::max(b + std::sqrt(b * b - c), 0.0)};
}

void expectPixel(const RenderedImages& images, uint32_t x, uint32_t y, const glm::dvec3& colour, double alpha,
                 double depth) {
  for (int c = 0; c < 3; ++c) ASSERT_NEAR(images.colour.pixel(x, y)[c], colour[c], 1e-6) << x << ", " << y;
  ASSERT_NEAR(*images.alpha.pixel(x, y), alpha, 1e-6) << x << ", " << y;
  ASSERT_NEAR(*images.distance.pixel(x, y), depth, 1e-5) << x << ", " << y;
}

//            ___
//  eye      /  |##\      a ball of radius 1 around (0, 0, 5) of which the half behind the face is solid; the
//  face
//   o----> (   |###)     lies at z = 5 - height
//           \__|##/
struct HalfBall {
  double height;  // < 1
  bool facesEye;
};
void PrintTo(const HalfBall& ball, std::ostream* stream) {
  *stream << (ball.facesEye ? "face towards the eye, height " : "face away, height ") << ball.height;
}
class OneCell : public ::testing::TestWithParam<HalfBall> {};

TEST_P(OneCell, ShowsTheSolidSideOfItsFace) {
  const auto [height, facesEye] = GetParam();
  const double density = 0.9;
  const glm::dvec3 colour(0.8, 0.4, 0.1);
  const Foam foam = foamOf({{.site = {0, 0, 5},
                             .density = float(density),
                             .colour = colour,
                             .orientation = facesEye ? kFaceTowardsMinusZ : kFaceTowardsPlusZ,
                             .height = float(height)}});
  const View view = lookAt({0, 0, 0}, {0, 0, 5}, 33, 31, 0.25);
  const RenderedImages images = renderFoam(foam, view);
  int seen = 0, found = 0;
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const glm::dvec3 direction = directionOf(view, x, y);
      Chord chord = chordOf({0, 0, 0}, direction, {0, 0, 5}, 1);
      if (facesEye) {
        chord.tNear = std::max(chord.tNear, (5 - height) / direction.z);
      } else {
        chord.tFar = std::min(chord.tFar, (5 + height) / direction.z);
      }
      const double alpha = 1 - std::exp(-density * chord.length());
      const double depth = alpha > 0.5 ? chord.tNear + std::log(2) / density : -1;
      expectPixel(images, x, y, alpha * colour, alpha, depth);
      const float* normal = images.normal.pixel(x, y);
      ASSERT_NEAR(normal[0], 0, 1e-6);
      ASSERT_NEAR(normal[1], 0, 1e-6);
      ASSERT_NEAR(normal[2], facesEye ? -alpha : alpha, 1e-6);
      seen += alpha > 0;
      found += depth > 0;
    }
  }
  EXPECT_GT(seen, 200);
  EXPECT_GT(found, 20);
}

INSTANTIATE_TEST_SUITE_P(Faces, OneCell,
                         ::testing::Values(HalfBall{0, true}, HalfBall{0.25, true}, HalfBall{-0.1, true},
                                           HalfBall{0, false}, HalfBall{0.25, false}, HalfBall{-0.1, false}));

TEST(OneCellOnly, BehindTheEyeIsNotSeen) {
  const Foam foam = foamOf({{.site = {0, 0, -5}}});
  const RenderedImages images = renderFoam(foam, lookAt({0, 0, 0}, {0, 0, 5}, 9, 9, 1));
  for (float alpha : images.alpha.values) EXPECT_EQ(alpha, 0);
  for (float depth : images.distance.values) EXPECT_EQ(depth, -1);
}

TEST(OneCellOnly, SeenFromInsideFillsTheViewFromTheEyeOn) {
  const Foam foam = foamOf({{.site = {0, 0, 0.25f}, .density = 2, .orientation = kFaceTowardsPlusZ}});
  const View view = lookAt({0, 0, 0}, {0, 0, 5}, 9, 9, 1);
  const RenderedImages images = renderFoam(foam, view);
  for (uint32_t y = 0; y < 9; ++y) {
    for (uint32_t x = 0; x < 9; ++x) {
      const Chord chord = chordOf({0, 0, 0}, directionOf(view, x, y), {0, 0, 0.25}, 1);
      ASSERT_EQ(chord.tNear, 0);
      const double alpha = 1 - std::exp(-2 * chord.tFar);
      expectPixel(images, x, y, glm::dvec3(0.5 * alpha), alpha, std::log(2) / 2);
    }
  }
}

TEST(OneCellOnly, TheDepthQuantileIsAParameter) {
  const Foam foam = foamOf({{.site = {0, 0, 5}, .orientation = kFaceTowardsPlusZ}});
  ReferenceOptions options = plainOptions();
  options.quantile = 0.9;
  const RenderedImages images = renderFoam(foam, lookAt({0, 0, 0}, {0, 0, 5}, 1, 1, 1e-3), options);
  EXPECT_NEAR(images.distance.values[0], 4 - std::log(0.9), 1e-5);
}

TEST(OneCellOnly, LobesAreSeenFromTheEyeTowardsTheDetailSite) {
  Foam foam = foamOf({{.site = {0, 0, 5}, .density = 1000, .orientation = kFaceTowardsMinusZ, .height = 0}});
  foam.lobeCount = 2;
  foam.detailSites[0] = {0.5f, 0};
  foam.lobeAxes = {{0, 0, 3}, {2, 0, 0}};
  foam.lobeColours = {{0.5f, -0.5f, -2}, {-0.5f, 0.5f, -2}};
  const RenderedImages images = renderFoam(foam, lookAt({0, 0, 0}, {0, 0, 5}, 1, 1, 1e-3));
  // The tangent of this orientation is row t of its matrix: (0, 1, 0).
  const glm::dvec3 seen = glm::normalize(glm::dvec3(0, 0.5, 5));
  const double a = std::exp(-3 * glm::length(seen - glm::dvec3(0, 0, 1))),
               b = std::exp(-2 * glm::length(seen - glm::dvec3(1, 0, 0)));
  EXPECT_NEAR(images.colour.values[0], 0.5 + 0.5 * (a - b) / (a + b), 1e-6);
  EXPECT_NEAR(images.colour.values[1], 0.5 - 0.5 * (a - b) / (a + b), 1e-6);
  EXPECT_EQ(images.colour.values[2], 0);
}

//   (   0   |   1   )    seen from below: the ball of each cell ends at the shared face x = 0
TEST(TwoCells, SideBySideEachFillsItsOwnSideOfTheFace) {
  const glm::vec4 away = kFaceTowardsPlusZ;
  const Foam foam = foamOf({{.site = {-0.6f, 0, 5}, .density = 2, .colour = {1, 0, 0}, .orientation = away},
                            {.site = {0.6f, 0, 5}, .colour = {0, 0, 1}, .orientation = away}});
  const View view = lookAt({0, 0, 0}, {0, 0, 5}, 40, 21, 0.25);
  const RenderedImages images = renderFoam(foam, view);
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const glm::dvec3 direction = directionOf(view, x, y);
      const bool isFirst = direction.x < 0;  // rays from the origin stay on their side of x = 0
      const Chord chord = chordOf({0, 0, 0}, direction, {isFirst ? -0.6f : 0.6f, 0, 5}, 1);
      const double density = isFirst ? 2 : 1, alpha = 1 - std::exp(-density * chord.length());
      const double depth = alpha > 0.5 ? chord.tNear + std::log(2) / density : -1;
      expectPixel(images, x, y, isFirst ? glm::dvec3(alpha, 0, 0) : glm::dvec3(0, 0, alpha), alpha, depth);
    }
  }
}

//           ____ __
//  eye     /    |  \        radii 1 and 0.8, one unit apart: the face lies at x = 0.5 (1 + 1 - 0.64) = 0.68
//   o---> (  0  |1  )
//          \____|__/
class InLine : public ::testing::Test {
 protected:
  static constexpr double kFace = 0.68;

  // The central ray comes from x = -5: cell 0 is met at t 4 .. 5.68, cell 1 at 5.68 .. 6.8.
  static RenderedImages render(const std::vector<PlainCell>& cells, const ReferenceOptions& options = plainOptions()) {
    return renderFoam(foamOf(cells), lookAt({-5, 0, 0}, {0, 0, 0}, 1, 1, 1e-3), options);
  }
  PlainCell front_{.site = {0, 0, 0}, .radius = 1, .density = 0.3f, .colour = {0.9f, 0.2f, 0}};
  PlainCell back_{.site = {1, 0, 0}, .radius = 0.8f, .density = 2, .colour = {0, 0.2f, 0.7f}};
};

TEST_F(InLine, TheFrontCellIsCompositedOverTheBackCell) {
  const double alphaFront = 1 - std::exp(-0.3 * (1 + kFace)), alphaBack = 1 - std::exp(-2 * (1.8 - kFace));
  const glm::dvec3 colour =
      alphaFront * glm::dvec3(0.9, 0.2, 0) + (1 - alphaFront) * alphaBack * glm::dvec3(0, 0.2, 0.7);
  const double depth = 5 + kFace + (std::log(2) - 0.3 * (1 + kFace)) / 2;
  expectPixel(render({front_, back_}), 0, 0, colour, 1 - (1 - alphaFront) * (1 - alphaBack), depth);
  expectPixel(render({back_, front_}), 0, 0, colour, 1 - (1 - alphaFront) * (1 - alphaBack), depth);
}

TEST_F(InLine, ACellWithoutDensityIsNotSeenButCuts) {
  front_.density = 0;
  const double alpha = 1 - std::exp(-2 * (1.8 - kFace));
  expectPixel(render({front_, back_}), 0, 0, alpha * glm::dvec3(0, 0.2, 0.7), alpha, 5 + kFace + std::log(2) / 2);
}

TEST_F(InLine, ACellSkippedByTheRatioIsNotSeenButCuts) {
  const double alpha = 1 - std::exp(-2 * (1.8 - kFace)), depth = 5 + kFace + std::log(2) / 2;
  ReferenceOptions options = plainOptions();
  options.nearRatio = 5.01;  // 5 units from radius 1, 6 units from radius 0.8
  expectPixel(render({front_, back_}, options), 0, 0, alpha * glm::dvec3(0, 0.2, 0.7), alpha, depth);
  options.nearRatio = 5;  // the limit itself is drawn
  EXPECT_GT(render({front_, back_}, options).colour.values[0], 0.1);
}

TEST_F(InLine, ACellSkippedByItsDepthIsNotSeenButCuts) {
  const double alpha = 1 - std::exp(-2 * (1.8 - kFace)), depth = 5 + kFace + std::log(2) / 2;
  ReferenceOptions options = plainOptions();
  options.nearDepth = 5.01;
  expectPixel(render({front_, back_}, options), 0, 0, alpha * glm::dvec3(0, 0.2, 0.7), alpha, depth);
  options.nearDepth = 5;
  EXPECT_GT(render({front_, back_}, options).colour.values[0], 0.1);
}

TEST_F(InLine, ARayEndsBehindTheCellThatTookItBelowTheCutoff) {
  front_.density = 3;  // leaves exp(-3 * 1.68) = 0.0065
  ReferenceOptions options = plainOptions();
  options.cutoff = 0.01;
  EXPECT_EQ(render({front_, back_}, options).colour.values[2], 0);
  options.cutoff = 0.006;
  EXPECT_GT(render({front_, back_}, options).colour.values[2], 0.004);
}

// Of coincident sites only the one with the largest radius, then the lowest index, exists.
TEST_F(InLine, ADuplicateDoesNotExist) {
  PlainCell smaller = front_, same = back_;
  smaller.radius = 0.9f;
  smaller.colour = same.colour = {0, 1, 0};
  smaller.density = same.density = 50;
  expectSameImages(render({front_, back_}), render({smaller, front_, back_, same}));
}

TEST_F(InLine, ABallWhollyInAnotherPowerCellChangesNothing) {
  const PlainCell covered{.site = {0.3f, 0, 0}, .radius = 0.01f, .density = 100};
  expectSameImages(render({front_, back_}), render({front_, covered, back_}));
}

}  // namespace
}  // namespace froth
