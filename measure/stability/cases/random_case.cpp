#include "measure/stability/cases/random_case.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "base/counter_random.h"
#include "base/float_span.h"
#include "reference/camera/view_pose.h"
#include "reference/camera/view_rays.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

// Draws one after the other.
class Dice {
 public:
  explicit Dice(uint64_t seed) : random_(seed, Purpose::kSite) {}

  double uniform(double low, double high) { return random_.uniform(next_++, low, high); }
  double logUniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  uint32_t below(size_t count) { return static_cast<uint32_t>(uniform(0, static_cast<double>(count))); }
  template <class Value, size_t count>
  Value pick(const Value (&values)[count]) {
    return values[below(count)];
  }
  double sign() { return chance(0.5) ? 1 : -1; }
  glm::dvec3 inCube(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  glm::dvec3 direction() {
    const double z = uniform(-1, 1), angle = uniform(0, glm::two_pi<double>()), radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  }
  glm::dvec3 axis() {
    glm::dvec3 unit(0);
    unit[static_cast<int>(below(3))] = sign();
    return unit;
  }

 private:
  CounterRandom random_;
  uint64_t next_ = 0;
};

// ---- The foam

enum class Places { kCube, kLattice, kAlmostLattice, kPlane, kLine, kSphere, kCluster };

// In units of the scene, about 1 across.
glm::dvec3 drawPlace(Dice& dice, Places places) {
  const auto onLattice = [&] { return glm::floor(dice.inCube(3)) * 0.25; };
  switch (places) {
    case Places::kLattice:
      return onLattice();
    case Places::kAlmostLattice:
      return onLattice() + dice.inCube(1) * dice.pick({1e-6, 1e-9, 0.0});
    case Places::kPlane:
      return {dice.uniform(-0.7, 0.7), dice.uniform(-0.7, 0.7), 0.25};
    case Places::kLine:
      return glm::dvec3(1, 2, -1) * (std::floor(dice.uniform(-16, 16)) / 32);
    case Places::kSphere:
      return dice.direction() * 0.5;
    case Places::kCluster:
      return dice.direction() * dice.logUniform(1e-6, 1);
    case Places::kCube:
      break;
  }
  return dice.inCube(0.7);
}

void drawSites(Dice& dice, Foam& foam, double unit) {
  const auto places = static_cast<Places>(dice.below(7));
  const double duplicates = dice.pick({0.0, 0.0, 0.3});
  const glm::dvec3 origin = dice.pick({0.0, 0.0, 0.0, 0.0, 1e2, 1e5}) * dice.direction();
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const bool isDuplicate = i > 0 && dice.chance(duplicates);
    foam.sites.push_back(isDuplicate ? foam.sites[dice.below(i)]
                                     : glm::vec3(unit * (origin + drawPlace(dice, places))));
  }
}

void drawRadii(Dice& dice, Foam& foam, double unit) {
  const uint32_t kind = dice.below(5);
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const double radius = kind == 0   ? 0.25
                          : kind == 1 ? dice.pick({0.25, 0.5, 0.3535533905932738})
                          : kind == 2 ? dice.logUniform(1e-3, 10)
                          : kind == 3 ? dice.logUniform(1e-6, 100)
                                      : dice.uniform(0.15, 0.5);
    foam.radii.push_back(static_cast<float>(unit * radius));
  }
}

void drawDensities(Dice& dice, Foam& foam, double unit) {
  const uint32_t kind = dice.below(3);
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const double ordinary = dice.uniform(0.5, 20), any = dice.logUniform(1e-12, 1e8);
    const double density = kind == 0 || dice.chance(0.3) ? ordinary : dice.chance(0.1) ? 0 : any;
    foam.densities.push_back(static_cast<float>(std::min(density / unit, 1e30)));
  }
}

void drawOrientations(Dice& dice, Foam& foam) {
  constexpr float kHalfRoot = 0.70710678f;
  const glm::vec4 aligned[] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {kHalfRoot, 0, kHalfRoot, 0}, {kHalfRoot, 0, 0, -kHalfRoot}};
  const double alignedShare = dice.pick({0.0, 0.3, 1.0});
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const glm::dvec3 axis = dice.direction();
    const double half = dice.uniform(0, glm::pi<double>());
    const glm::vec4 turned(glm::dvec4(std::cos(half), axis * std::sin(half)));
    foam.orientations.push_back(dice.chance(alignedShare) ? dice.pick(aligned) : glm::normalize(turned));
  }
}

void drawDetails(Dice& dice, Foam& foam) {
  const uint32_t places = dice.below(5), heights = dice.below(5);
  const glm::vec2 common(dice.uniform(-0.5, 0.5), dice.uniform(-0.5, 0.5));
  for (uint32_t i = 0; i < foam.cellCount * foam.detailCount; ++i) {
    const glm::vec2 place(dice.uniform(-0.7, 0.7), dice.uniform(-0.7, 0.7));
    const auto sign = static_cast<float>(dice.sign());
    foam.detailSites.push_back(places == 0   ? common
                               : places == 1 ? glm::vec2(0)
                               : places == 2 ? place * static_cast<float>(dice.pick({1.0, 3.0, 1e3}))
                                             : place);
    foam.detailHeights.push_back(heights == 0   ? 0
                                 : heights == 1 ? sign * static_cast<float>(dice.logUniform(1e-8, 1e3))
                                 : heights == 2 ? sign * 2
                                                : static_cast<float>(dice.uniform(-0.4, 0.4)));
  }
}

void drawLobes(Dice& dice, Foam& foam) {
  const uint32_t temperatures = dice.below(4), colours = dice.below(4);
  const uint32_t lobes = foam.cellCount * foam.detailCount * foam.lobeCount;
  for (uint32_t i = 0; i < lobes; ++i) {
    const double ordinary = dice.uniform(0.2, 6), any = dice.pick({0.0, 1e-6, 1e2, 1e4});
    foam.lobeAxes.push_back(glm::vec3(dice.direction() * (temperatures == 0 ? any : ordinary)));
    const double size = colours == 0 ? dice.pick({0.0, 1e-30, 0.5, 1e3}) : 0.5;
    foam.lobeColours.push_back(glm::vec3(dice.inCube(size)));
  }
}

// Few, as a GPU compiles its shaders for each: detail sites of a cell, lobes of a detail site.
constexpr std::array<uint32_t, 2> kFoamShapes[] = {{1, 1}, {4, 2}, {4, 2}, {8, 8}};

// One number of one array far outside of what the others are, where its square is a float yet.
void spoil(Dice& dice, Foam& foam) {
  const std::span<float> arrays[] = {floatsOf(foam.sites),       floatsOf(foam.radii),         floatsOf(foam.densities),
                                     floatsOf(foam.detailSites), floatsOf(foam.detailHeights), floatsOf(foam.lobeAxes),
                                     floatsOf(foam.lobeColours)};
  const std::span<float> numbers = dice.pick(arrays);
  float& number = numbers[dice.below(numbers.size())];
  number = std::copysign(static_cast<float>(dice.logUniform(1e-15, 1e15)), number);
}

Foam drawFoam(Dice& dice, double unit) {
  Foam foam;
  foam.cellCount = static_cast<uint32_t>(dice.logUniform(2, 41));
  const auto [details, lobes] = dice.pick(kFoamShapes);
  foam.detailCount = details;
  foam.lobeCount = lobes;
  drawSites(dice, foam, unit);
  drawRadii(dice, foam, unit);
  drawDensities(dice, foam, unit);
  drawOrientations(dice, foam);
  drawDetails(dice, foam);
  drawLobes(dice, foam);
  if (dice.chance(0.2)) spoil(dice, foam);
  return foam;
}

// ---- The views

// A point of the radical plane of two cells, between their sites.
glm::dvec3 betweenCells(const Foam& foam, uint32_t a, uint32_t b) {
  const glm::dvec3 from(foam.sites[a]), across = glm::dvec3(foam.sites[b]) - from;
  const double squared = glm::dot(across, across);
  if (!(squared > 0)) return from;
  const double r = foam.radii[a], s = foam.radii[b];
  return from + across * (0.5 * (squared + (r - s) * (r + s)) / squared);
}

glm::dvec3 drawEye(Dice& dice, const Foam& foam, double unit) {
  const uint32_t cell = dice.below(foam.cellCount), other = dice.below(foam.cellCount);
  const glm::dvec3 site(foam.sites[cell]);
  const double radius = foam.radii[cell];
  const FaceFrame<double> frame = faceFrame<double>(foam.orientations[cell]);
  switch (dice.below(8)) {
    case 0:
      return site;
    case 1:
      return site + radius * dice.axis();
    case 2:
      return site + radius * dice.direction();
    case 3:
      return betweenCells(foam, cell, other);
    case 4:
      return site + radius * (dice.uniform(-2, 2) * frame.tangent + dice.uniform(-2, 2) * frame.bitangent);
    case 5:
      return site + unit * dice.logUniform(1, 1e4) * dice.direction();
    case 6:
      return site + unit * std::floor(dice.uniform(1, 5)) * dice.axis();
    default:
      return site + unit * dice.uniform(0.5, 3) * dice.direction();
  }
}

glm::dvec3 upBeside(const glm::dvec3& forward) {
  return std::abs(forward.y) < 0.9 ? glm::dvec3(0, -1, 0) : glm::dvec3(1, 0, 0);
}

View drawView(Dice& dice, const Foam& foam, double unit) {
  constexpr std::array<uint32_t, 2> kSizes[] = {{32, 24}, {16, 16}, {17, 9}, {32, 1}, {1, 1}};
  const glm::dvec3 eye = drawEye(dice, foam, unit);
  const glm::dvec3 target(foam.sites[dice.below(foam.cellCount)]);
  const bool isAligned = dice.chance(0.3) || !(glm::distance(eye, target) > 0);
  const glm::dvec3 forward = isAligned ? dice.axis() : glm::normalize(target - eye);
  View view;
  setPose(view, eye, forward, upBeside(forward));
  const auto [width, height] = dice.pick(kSizes);
  view.width = width;
  view.height = height;
  view.cx = width / 2.0;
  view.cy = height / 2.0;
  const double halfAngle = glm::radians(dice.pick({0.5, 20.0, 35.0, 45.0, 89.5}));
  view.fx = view.fy = std::max(width, height) / (2 * std::tan(halfAngle));
  if (dice.chance(0.1)) {
    view.lens.kind = LensKind::kEquirectangular;
    view.fx = width / glm::two_pi<double>();
    view.fy = height / glm::pi<double>();
  } else if (dice.chance(0.1)) {
    view.lens.kind = LensKind::kOrthographic;
    view.fx = view.fy = std::max(width, height) / (dice.pick({1e-3, 1.0, 3.0}) * unit);
  }
  view.nearRatio = dice.pick({0.0, 0.0, 0.0, 4.0});
  view.nearDepth = 0;
  return view;
}

// ---- Instances, ends of rays, and what assets and devices have of their own

glm::quat drawTurn(Dice& dice) {
  constexpr float kHalfRoot = 0.70710678f;
  const glm::quat aligned[] = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {kHalfRoot, 0, 0, kHalfRoot}};
  const double half = dice.uniform(0, glm::pi<double>());
  const glm::dquat turned(std::cos(half), dice.direction() * std::sin(half));
  return dice.chance(0.5) ? dice.pick(aligned) : glm::normalize(glm::quat(turned));
}

enum class Arrangement { kCoinciding, kBeside, kAcross, kOfAnySize };

// Turned and scaled about `pivot`, so that an instance of a foam far from its origin lies where the others do.
CasePlace drawPlace(Dice& dice, Arrangement arrangement, const glm::dvec3& pivot, double unit) {
  CasePlace place;
  if (arrangement == Arrangement::kCoinciding) return place;
  place.rotation = drawTurn(dice);
  glm::dvec3 shift = unit * dice.inCube(0.7);
  if (arrangement == Arrangement::kBeside) shift = unit * 0.25 * std::floor(dice.uniform(0, 5)) * dice.axis();
  if (arrangement == Arrangement::kAcross) {
    place.scale = static_cast<float>(dice.pick({1.0, 0.5, dice.uniform(0.5, 2)}));
  }
  if (arrangement == Arrangement::kOfAnySize) place.scale = static_cast<float>(dice.logUniform(1e-3, 1e3));
  place.position = pivot + shift - glm::normalize(glm::dquat(place.rotation)) * (double{place.scale} * pivot);
  return place;
}

// The first stays as it is: what the views were drawn for.
void drawPlaces(Dice& dice, double unit, StiffCase& drawn) {
  const auto arrangement = static_cast<Arrangement>(dice.below(4));
  const glm::dvec3 pivot(drawn.foam.sites[dice.below(drawn.foam.cellCount)]);
  drawn.places.resize(2 + dice.below(kMostPlaces - 1));
  for (size_t i = 1; i < drawn.places.size(); ++i) drawn.places[i] = drawPlace(dice, arrangement, pivot, unit);
}

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

// Where a ray enters or leaves one of the balls; never where it misses that.
double drawEndOnBall(Dice& dice, const Foam& foam, const View& view, const std::optional<ViewRay>& ray) {
  const uint32_t cell = dice.below(foam.cellCount);
  const bool isEntry = dice.chance(0.5);
  double tNear = 0, tFar = 0;
  if (!ray) return kNoEnd;
  const glm::dvec3 centre = glm::dvec3(foam.sites[cell]) - (eyeOf(view) + ray->offset);
  if (!foam::intersectBall(centre, double{foam.radii[cell]}, ray->direction, tNear, tFar)) return kNoEnd;
  return isEntry ? tNear : tFar;
}

// About `size`, or at, behind and beyond everything.
double drawAnyEnd(Dice& dice, double size) {
  const double share = dice.uniform(0, 1), end = size * dice.logUniform(0.1, 3);
  return share < 0.1 ? 0 : share < 0.2 ? -end : share < 0.35 ? kNoEnd : end;
}

enum class Ends { kSmooth, kAny, kOnBalls, kOne };

Image drawEndsOf(Dice& dice, const Foam& foam, const View& view, double unit) {
  const auto kind = static_cast<Ends>(dice.below(4));
  const double toSite = glm::distance(eyeOf(view), glm::dvec3(foam.sites[dice.below(foam.cellCount)]));
  const double size = std::max(toSite, 1e-3 * unit) * dice.uniform(0.5, 1.5);
  const double across = dice.uniform(-1.5, 1.5), down = dice.uniform(-1.5, 1.5), one = drawAnyEnd(dice, size);
  const ViewRays rays(view);
  Image ends{view.width, view.height, 1, {}};
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const double smooth =
          size * (1 + across * (x / double(view.width) - 0.5) + down * (y / double(view.height) - 0.5));
      const double end = kind == Ends::kSmooth    ? smooth
                         : kind == Ends::kAny     ? drawAnyEnd(dice, size)
                         : kind == Ends::kOnBalls ? drawEndOnBall(dice, foam, view, rays.ofPixel(x, y))
                                                  : one;
      ends.values.push_back(static_cast<float>(end));
    }
  }
  return ends;
}

// Each in few cases, so that most have none of them. Drawn last: a seed's foam and views are what they were before
// there were parts.
void drawParts(Dice& dice, double unit, StiffCase& drawn) {
  if (dice.chance(0.15)) drawPlaces(dice, unit, drawn);
  if (dice.chance(0.15)) {
    for (const View& view : drawn.views) drawn.ends.push_back(drawEndsOf(dice, drawn.foam, view, unit));
  }
  if (dice.chance(0.06)) drawn.jitter = glm::floor(glm::vec2(dice.inCube(dice.pick({8.0, 64.0})))) / 16.0f;
  if (dice.chance(0.08)) drawn.layers = 1 + dice.below(kAllLayersOfCase - 1);
  if (dice.chance(0.1)) drawn.chunkCells = dice.pick({1u, 2u, 5u, 16u});
}

}  // namespace

StiffCase drawCase(uint64_t seed) {
  Dice dice(seed);
  StiffCase drawn;
  drawn.name = fmt::format("random/{}", seed);
  drawn.what = "drawn at random";
  const double unit = dice.pick({1.0, 1.0, 1.0, 1e-6, 1e-3, 1e3, 1e6});
  drawn.foam = drawFoam(dice, unit);
  const uint32_t views = 1 + dice.below(2);
  for (uint32_t i = 0; i < views; ++i) {
    drawn.views.push_back(drawView(dice, drawn.foam, unit));
    drawn.views.back().name = fmt::format("view_{:02}", i);
  }
  drawParts(dice, unit, drawn);
  return drawn;
}

}  // namespace froth
