// What ReferenceOptions change of a ray: where the scene ends it, and detail sites of little weight.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "reference/render/merged_foams.h"
#include "reference/render/reference_state.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kSharpness = 10;  // ReferenceOptions::detailSharpness
constexpr double kLeastShare = 1.0 / 1024;

// ---- leastShare

struct Detail {
  double weight;  // 1 at the site itself
  glm::vec3 colour;
  float height;
};

// One ball around (0, 0, 5), its face in its middle towards the eye. The ray along z meets the face in its own middle,
// where a detail site has the weight exp(-10 d^2), d its distance from there.
Foam ballOf(const std::vector<Detail>& details) {
  Foam foam = foamOf({{.site = {0, 0, 5}, .orientation = kFaceTowardsMinusZ, .height = 0}});
  foam.detailCount = static_cast<uint32_t>(details.size());
  foam.detailSites.clear();
  foam.detailHeights.clear();
  foam.lobeAxes.assign(details.size(), glm::vec3(1, 0, 0));
  foam.lobeColours.clear();
  for (const Detail& detail : details) {
    foam.detailSites.emplace_back(std::sqrt(std::max(-std::log(detail.weight) / kSharpness, 0.0)), 0);
    foam.detailHeights.push_back(detail.height);
    foam.lobeColours.push_back(detail.colour - 0.5f);
  }
  return foam;
}

// Its one pixel, without what the ball lets through.
glm::dvec3 colourOf(const Foam& foam, double leastShare, float* depth = nullptr) {
  ReferenceOptions options = plainOptions();
  options.leastShare = leastShare;
  const RenderedImages images = renderFoam(foam, lookAt({0, 0, 0}, {0, 0, 1}, 1, 1, 1e-3), options);
  if (depth) *depth = images.distance.values[0];
  const float* const colour = images.colour.values.data();
  return glm::dvec3(colour[0], colour[1], colour[2]) / double{images.alpha.values[0]};
}

void expectColour(const glm::dvec3& found, const glm::dvec3& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-6);
}

constexpr glm::dvec3 kFirst(0.2, 0.4, 0.6), kSecond(1, 3, 0), kThird(0, 1, 1);

TEST(LeastShare, LeavesOutWhatHasLessOfAllWeights) {
  // A weight w beside one of 1 is the share w / (1 + w) of both.
  for (const double share : {0.98 * kLeastShare, 1.02 * kLeastShare}) {
    const double weight = share / (1 - share);
    const Foam foam = ballOf({{1, kFirst, 0}, {weight, kSecond, 0}});
    const glm::dvec3 both = (1 - share) * kFirst + share * kSecond;
    expectColour(colourOf(foam, 0), both);
    expectColour(colourOf(foam, kLeastShare), share < kLeastShare ? kFirst : both);
  }
}

TEST(LeastShare, GivesWhatIsLeftTheWholeOfTheWeight) {
  const double weight = 0.3;
  const Foam foam = ballOf({{1, kFirst, 0}, {weight, kSecond, 0}, {0.1, kThird, 0}});
  expectColour(colourOf(foam, 0.1), (kFirst + weight * kSecond) / (1 + weight));  // the third has 0.1 / 1.4
  expectColour(colourOf(foam, 0.07), (kFirst + weight * kSecond + 0.1 * kThird) / 1.4);
}

TEST(LeastShare, ChangesNoHeight) {
  const Foam foam = ballOf({{1, kFirst, 0.1f}, {0.05, kSecond, -0.9f}});
  float all = 0, some = 0, first = 0;
  colourOf(foam, 0, &all);
  expectColour(colourOf(foam, 0.1, &some), kFirst);
  EXPECT_EQ(all, some);
  colourOf(ballOf({{1, kFirst, 0.1f}}), 0, &first);
  EXPECT_GT(std::abs(all - first), 0.01f) << "a height that does not show";
}

// Far from all detail sites every weight is 0 in double: no share of nothing.
TEST(LeastShare, OfNoWeightAtAllIsANumber) {
  Foam foam = ballOf({{1, kFirst, 0}, {1, kSecond, 0}});
  for (glm::vec2& site : foam.detailSites) site = glm::vec2(1e3f);
  expectColour(colourOf(foam, kLeastShare), glm::dvec3(0));
}

TEST(LeastShare, IsThatOfSeveralFoamsToo) {
  const Foam foam = ballOf({{1, kFirst, 0}, {0.05, kSecond, 0}});
  const ReferenceRenderer renderer(foam);
  const View view = lookAt({0, 0, 0}, {0, 0, 1}, 1, 1, 1e-3);
  const std::array<PlacedFoam, 2> foams = {PlacedFoam{&renderer, {0, 0, 0}}, {&renderer, {0, 0, 100}}};
  ReferenceOptions options = plainOptions();
  for (const double leastShare : {0.0, 0.1}) {
    options.leastShare = leastShare;
    const Result<RenderedImages> merged = renderMerged(foams, view, options);
    ASSERT_TRUE(merged);
    const float* const colour = merged->colour.values.data();
    expectColour(glm::dvec3(colour[0], colour[1], colour[2]) / double{merged->alpha.values[0]},
                 colourOf(foam, leastShare));
  }
}

// ---- Ends of rays

struct Ended {
  Image image;
  ReferenceOptions options = plainOptions();

  explicit Ended(Image ends) : image(std::move(ends)) { options.sceneDistance = &image; }
  Ended(const Ended&) = delete;
};

Image endsOf(uint32_t width, uint32_t height, float end) {
  return {width, height, 1, std::vector<float>(size_t{width} * height, end)};
}

TEST(EndOfRay, IsThatOfItsOwnPixelAndElseNowhere) {
  const ViewRay ray{{0, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(endOfRay(plainOptions(), ray, 1, 1), kNever);
  Ended ended({3, 2, 1, {1, 2, 3, 4, static_cast<float>(kNever), -6}});
  EXPECT_EQ(endOfRay(ended.options, ray, 1, 0), 2);
  EXPECT_EQ(endOfRay(ended.options, ray, 0, 1), 4);
  EXPECT_EQ(endOfRay(ended.options, ray, 2, 1), -6);
  for (const double rounding : {0.0, 0x1p-21}) {
    ended.options.rounding = rounding;
    EXPECT_EQ(endOfRay(ended.options, ray, 1, 1), kNever) << "no end is off by nothing";
  }
}

// Errors of all pixels of an image, over what they are relative to: spread over -1 to 1, and reach nearly both.
void expectErrorsOf(const Ended& ended, const ViewRay& ray, double magnitude) {
  std::set<double> errors;
  for (uint32_t y = 0; y < ended.image.height; ++y) {
    for (uint32_t x = 0; x < ended.image.width; ++x) {
      errors.insert((endOfRay(ended.options, ray, x, y) - *ended.image.pixel(x, y)) /
                    (ended.options.rounding * magnitude));
    }
  }
  EXPECT_EQ(errors.size(), ended.image.values.size()) << "each pixel errs by itself";
  EXPECT_GE(*errors.begin(), -1.0001);
  EXPECT_LE(*errors.begin(), -0.98);
  EXPECT_LE(*errors.rbegin(), 1.0001);
  EXPECT_GE(*errors.rbegin(), 0.98);
}

TEST(EndOfRay, ErrsByPartsOfItsDistanceFromTheEye) {
  Ended ended(endsOf(32, 24, 8));
  ended.options.rounding = 0x1p-21;
  const ViewRay ray{{0, 0, 0}, {0, 0.6, 0.8}};
  expectErrorsOf(ended, ray, 8);
  const double first = endOfRay(ended.options, ray, 3, 4);
  EXPECT_EQ(endOfRay(ended.options, ray, 3, 4), first);
  ended.options.roundingSeed = 1;
  EXPECT_NE(endOfRay(ended.options, ray, 3, 4), first);
}

// Of parallel rays that is further than the end itself, and 0 is no exact end.
TEST(EndOfRay, OfParallelRaysErrsByTheirDistanceFromTheEyeToo) {
  Ended ended(endsOf(32, 24, 12));
  ended.options.rounding = 0x1p-21;
  const ViewRay ray{{3, -4, 0}, {0, 0, 1}};
  expectErrorsOf(ended, ray, 13);
  ended.image = endsOf(32, 24, 0);
  double largest = 0;
  uint32_t atOnce = 0;
  for (uint32_t x = 0; x < 32; ++x) {
    const double end = endOfRay(ended.options, ray, x, 0);
    EXPECT_GE(end, 0) << "an end before the start of its ray";
    atOnce += end == 0;
    largest = std::max(largest, end);
  }
  EXPECT_GT(atOnce, 5u);
  EXPECT_GT(largest, 0.8 * 5 * 0x1p-21);
  EXPECT_LE(largest, 5 * 0x1p-21);
  const double atEye = endOfRay(ended.options, ray, 1, 0), alsoAtEye = endOfRay(ended.options, ray, 2, 0);
  ended.image = endsOf(32, 24, -7);
  EXPECT_EQ(endOfRay(ended.options, ray, 1, 0), atEye) << "an end behind the start of its ray is at it";
  EXPECT_EQ(endOfRay(ended.options, ray, 2, 0), alsoAtEye);
}

// A depth along the axis is divided by a cosine, whose rounding does not shrink with it.
TEST(EndOfRay, FromADepthErrsByTheInverseOfTheCosine) {
  Ended ended(endsOf(32, 24, 8));
  ended.options.rounding = 0x1p-21;
  ended.options.depthAxis = {0, 0, 1};
  const double cosine = 0.01;
  expectErrorsOf(ended, {{0, 0, 0}, {0, std::sqrt(1 - cosine * cosine), cosine}}, 8 / cosine);
  expectErrorsOf(ended, {{0, 0, 0}, {0, 0, 1}}, 8);
}

// A ball of radius 1 around (0, 0, 5) that is solid throughout.
TEST(EndedRays, ShowWhatLiesBeforeTheEndAndNothingElse) {
  const double density = 0.9;
  const Foam foam = foamOf({{.site = {0, 0, 5}, .density = float(density)}});
  const View view = lookAt({0, 0, 0}, {0, 0, 1}, 1, 1, 1e-6);
  const ReferenceRenderer renderer(foam);
  const PlacedFoam halfAsLarge{&renderer, {0, 0, 0}, {1, 0, 0, 0}, 0.5};  // from 2 to 3
  for (const float end : {-1.0f, 0.0f, 2.25f, 3.5f, 4.0f, 4.25f, 5.5f, 6.0f, 7.0f, static_cast<float>(kNever)}) {
    const Ended ended(endsOf(1, 1, end));
    const auto alphaOf = [&](double from, double to, double perLength) {
      return 1 - std::exp(-perLength * std::max(std::min(double{end}, to) - from, 0.0));
    };
    EXPECT_NEAR(renderFoam(foam, view, ended.options).alpha.values[0], alphaOf(4, 6, density), 1e-6) << end;
    const Result<RenderedImages> merged = renderMerged(std::span(&halfAsLarge, 1), view, ended.options);
    ASSERT_TRUE(merged);
    EXPECT_NEAR(merged->alpha.values[0], alphaOf(2, 3, 2 * density), 1e-6) << end;
  }
}

TEST(CutOffRays, OfSeveralFoamsEndWhereTransmittanceIsTheCutoff) {
  const Foam foam = foamOf({{.site = {0, 0, 5}, .density = 3}});  // leaves exp(-6) = 0.0025
  const View view = lookAt({0, 0, 0}, {0, 0, 1}, 1, 1, 1e-6);
  const ReferenceRenderer renderer(foam);
  const PlacedFoam placed{&renderer, {0, 0, 0}};
  ReferenceOptions options = plainOptions();
  for (const double cutoff : {0.0, 0.001, 0.0025, 0.01, 0.5}) {
    options.cutoff = cutoff;
    const Result<RenderedImages> merged = renderMerged(std::span(&placed, 1), view, options);
    ASSERT_TRUE(merged);
    EXPECT_NEAR(merged->alpha.values[0], 1 - std::max(std::exp(-6.0), cutoff), 1e-6) << cutoff;
  }
}

TEST(EndedRays, NeedAnImageOfTheViewsSize) {
  const Foam foam = foamOf({{.site = {0, 0, 5}}});
  const Ended ended(endsOf(4, 8, 1));
  const Result<RenderedImages> images =
      ReferenceRenderer(foam).render(lookAt({0, 0, 0}, {0, 0, 1}, 8, 4, 1), ended.options);
  ASSERT_FALSE(images);
  EXPECT_EQ(images.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace froth
