#include "measure/stability/published_forms.h"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/counter_random.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/compositing.h"

namespace froth {
namespace {

constexpr uint64_t kInputs = 256;

// 10^first, 10^(first + step), ... 10^last.
std::vector<double> powersOfTen(double first, double last, double step) {
  std::vector<double> powers;
  const int count = static_cast<int>(std::lround((last - first) / step));
  for (int i = 0; i <= count; ++i) powers.push_back(std::pow(10.0, first + step * i));
  return powers;
}

// errorOf(abscissa, input): of one random input.
FormSeries largestErrors(const char* name, const std::vector<double>& abscissae,
                         const std::function<double(double abscissa, uint64_t input)>& errorOf) {
  FormSeries series{name, {}};
  for (const double abscissa : abscissae) {
    double largest = 0;
    for (uint64_t input = 0; input < kInputs; ++input) {
      const double error = errorOf(abscissa, input);
      largest = std::max(largest, error < kLargestError ? error : kLargestError);  // NaN too
    }
    series.errors.push_back(largest);
  }
  return series;
}

float asHalf(float value) { return glm::unpackHalf1x16(glm::packHalf1x16(value)); }

// ---- Radical planes

// Two overlapping balls of about unit size, and a ray from a few radii before them that meets their plane.
struct PlaneInput {
  glm::dvec3 site, other, eye, direction;  // from the scene's middle
  float radius, otherRadius;
};

PlaneInput planeInput(uint64_t input) {
  const CounterRandom places(1, Purpose::kSite), eyes(1, Purpose::kEye), radii(1, Purpose::kRadius);
  PlaneInput plane;
  // Floats, as chunks hold them.
  plane.site = glm::dvec3(glm::vec3(places.direction(2 * input)));
  plane.other = glm::dvec3(glm::vec3(plane.site + places.direction(2 * input + 1)));
  plane.radius = static_cast<float>(radii.uniform(2 * input, 0.8, 1.2));
  plane.otherRadius = static_cast<float>(radii.uniform(2 * input + 1, 0.8, 1.2));
  const glm::dvec3 across = plane.other - plane.site;
  glm::dvec3 eyeSide = eyes.direction(input);
  if (std::abs(glm::dot(eyeSide, across)) < 0.3) eyeSide = -glm::normalize(across);  // not a grazing ray
  plane.eye = plane.site + 4.0 * eyeSide;
  plane.direction = -eyeSide;
  return plane;
}

double exactPlaneDistance(const PlaneInput& plane) {
  const glm::dvec3 toNeighbour = plane.other - plane.site;
  const double offset = foam::radicalOffset(toNeighbour, double{plane.radius}, double{plane.otherRadius});
  return foam::radicalClearance(plane.site - plane.eye, toNeighbour, offset) / glm::dot(toNeighbour, plane.direction);
}

// n . x = c in world coordinates, with n = p_j - p_i and c = (|p_j|^2 - |p_i|^2 + r_i^2 - r_j^2) / 2; stored as `store`
// does.
double worldPlaneError(const PlaneInput& plane, double distance, const std::function<float(float)>& store) {
  const glm::dvec3 middle(distance, 0, 0);
  const glm::vec3 site(middle + plane.site), other(middle + plane.other), eye(middle + plane.eye),
      direction(plane.direction);
  const glm::vec3 difference = other - site;
  const glm::vec3 normal(store(difference.x), store(difference.y), store(difference.z));
  const float offset = store(0.5f * (glm::dot(other, other) - glm::dot(site, site) + plane.radius * plane.radius -
                                     plane.otherRadius * plane.otherRadius));
  return std::abs((offset - glm::dot(normal, eye)) / glm::dot(normal, direction) - exactPlaneDistance(plane));
}

// As the runtime does: eye and placement are subtracted in double.
double localPlaneError(const PlaneInput& plane, double distance) {
  const glm::dvec3 middle(distance, 0, 0);
  const glm::vec3 centre(plane.site + (middle - (middle + plane.eye))), toNeighbour(plane.other - plane.site),
      direction(plane.direction);
  const float offset = foam::radicalOffset(toNeighbour, plane.radius, plane.otherRadius);
  const float clearance = foam::radicalClearance(centre, toNeighbour, offset);
  return std::abs(clearance / glm::dot(toNeighbour, direction) - exactPlaneDistance(plane));
}

PublishedForm compareRadicalPlanes() {
  PublishedForm form{
      "radical_planes",
      "Where a ray meets the plane between two cells of unit size: world coordinates n . x = c, stored as fp16 as "
      "published or as floats, against d . x' = m in the cell's own frame",
      "distance of the scene from the origin [radii]",
      "error of the distance along the ray [radii]",
      powersOfTen(0, 9, 0.5),
      {}};
  form.series = {largestErrors("published: world, fp16", form.abscissae,
                               [](double x, uint64_t i) { return worldPlaneError(planeInput(i), x, asHalf); }),
                 largestErrors("world, float", form.abscissae,
                               [](double x, uint64_t i) {
                                 return worldPlaneError(planeInput(i), x, [](float value) { return value; });
                               }),
                 largestErrors("Froth: local, float", form.abscissae,
                               [](double x, uint64_t i) { return localPlaneError(planeInput(i), x); })};
  return form;
}

// ---- Balls

// The chord of a ray through the unit ball at `distance`, passing its centre at a random part of the radius.
struct ChordInput {
  glm::dvec3 centre, direction;
};

ChordInput chordInput(double distance, uint64_t input) {
  const CounterRandom directions(2, Purpose::kDirection), places(2, Purpose::kSite);
  const glm::dvec3 direction(glm::vec3(directions.direction(input)));
  const glm::dvec3 aside = glm::normalize(glm::cross(direction, directions.direction(input + kInputs)));
  return {glm::dvec3(glm::vec3(distance * direction + places.uniform(input, 0, 0.9) * aside)), direction};
}

double exactChord(const ChordInput& input) {
  const double squared = glm::dot(input.direction, input.direction),
               along = glm::dot(input.centre, input.direction) / squared;
  const glm::dvec3 perpendicular = input.centre - along * input.direction;
  return 2 * std::sqrt(std::max(1 - glm::dot(perpendicular, perpendicular), 0.0) / squared);
}

double quadraticError(const ChordInput& input) {
  const glm::vec3 centre(input.centre), direction(input.direction);
  const float a = glm::dot(direction, direction), b = -2 * glm::dot(centre, direction),
              c = glm::dot(centre, centre) - 1;
  const float root = std::sqrt(std::max(b * b - 4 * a * c, 0.0f));
  return std::abs((-b + root) / (2 * a) - (-b - root) / (2 * a) - exactChord(input));
}

double perpendicularError(const ChordInput& input) {
  float tNear = 0, tFar = 0;
  foam::intersectBall(glm::vec3(input.centre), 1.0f, glm::vec3(input.direction), tNear, tFar);
  return std::abs(std::max(tFar - tNear, 0.0f) - exactChord(input));
}

PublishedForm compareBalls() {
  PublishedForm form{
      "balls",
      "The chord of a ray in a ball: the roots of a t^2 + b t + c, against the perpendicular distance of the centre",
      "distance from the eye [radii]",
      "error of the chord [radii]",
      powersOfTen(0.5, 7, 0.5),
      {}};
  form.series = {largestErrors("published: b^2 - 4ac", form.abscissae,
                               [](double x, uint64_t i) { return quadraticError(chordInput(x, i)); }),
                 largestErrors("Froth: perpendicular", form.abscissae,
                               [](double x, uint64_t i) { return perpendicularError(chordInput(x, i)); })};
  return form;
}

// ---- The near test's forward vector

// The depth at which cells begin to be drawn with a limit of 1, by bisection along `forward`, whose length is what the
// lens makes it.
double nearLimit(const glm::vec3& axis, const glm::vec3& forward) {
  float low = 0, high = 1e12f;
  while (std::nextafter(low, high) < high) {
    const float depth = 0.5f * low + 0.5f * high;
    (foam::isNearCell(depth * axis, 0.1f, forward, 0.0f, 1.0f) ? low : high) = depth;
  }
  return high;
}

PublishedForm compareForwardVectors() {
  PublishedForm form{"forward_vectors",
                     "The depth below which cells are left out: along the product of the image's half-extents, which "
                     "is as long as the "
                     "lens is wide, against a unit vector",
                     "tangent of half the field of view",
                     "relative error of the limit",
                     powersOfTen(-2, 2, 0.25),
                     {}};
  const CounterRandom directions(3, Purpose::kDirection);
  const auto errorOf = [=](uint64_t input, double length) {
    const glm::vec3 axis(directions.direction(input));
    return std::abs(nearLimit(axis, static_cast<float>(length) * axis) - 1);
  };
  form.series = {
      largestErrors("published: as long as the lens makes it", form.abscissae,
                    [&](double x, uint64_t i) { return errorOf(i, x * x); }),
      largestErrors("Froth: unit vector", form.abscissae, [&](double, uint64_t i) { return errorOf(i, 1); })};
  return form;
}

// ---- Opacity

PublishedForm compareOpacities() {
  PublishedForm form{
      "opacities",
      "Opacity of an interval: 1 - exp(-x) as it stands, against a series below 1/16 as the shaders have it",
      "optical depth",
      "relative error of the opacity",
      powersOfTen(-9, 2, 0.5),
      {}};
  const CounterRandom jitter(4, Purpose::kDensity);
  const auto relative = [=](double x, uint64_t input, auto&& opacityOf) {
    const float depth = static_cast<float>(x * jitter.uniform(input, 0.8, 1.25));
    const double exact = -std::expm1(-double{depth});
    return std::abs(opacityOf(depth) - exact) / exact;
  };
  const auto direct = [](float depth) { return 1.0f - std::exp(-depth); };
  const auto ours = [=](float depth) { return depth < 0.0625f ? foam::seriesOpacity(depth) : direct(depth); };
  form.series = {largestErrors("published: 1 - exp(-x)", form.abscissae,
                               [&](double x, uint64_t i) { return relative(x, i, direct); }),
                 largestErrors("Froth: series below 1/16", form.abscissae,
                               [&](double x, uint64_t i) { return relative(x, i, ours); })};
  return form;
}

}  // namespace

std::vector<PublishedForm> comparePublishedForms() {
  return {compareRadicalPlanes(), compareBalls(), compareForwardVectors(), compareOpacities()};
}

std::string tableOf(const PublishedForm& form) {
  std::string table = fmt::format("{}: {}.\n\n| {} |", form.error, form.what, form.abscissa), rule = "|---|";
  for (const FormSeries& series : form.series) {
    table += fmt::format(" {} |", series.name);
    rule += "---|";
  }
  table += '\n' + rule + '\n';
  for (size_t i = 0; i < form.abscissae.size(); ++i) {
    table += fmt::format("| {:.2g} |", form.abscissae[i]);
    for (const FormSeries& series : form.series) {
      const double error = series.errors[i];
      table += error < kLargestError ? fmt::format(" {:.1e} |", error) : std::string(" ≥ 10 |");
    }
    table += '\n';
  }
  return table;
}

Plot plotOf(const PublishedForm& form) {
  Plot plot;
  plot.title = form.what;
  plot.x = {form.abscissa, true, {}, {}, {}};
  plot.y = {form.error, true, {}, 1e-9, kLargestError};
  for (const FormSeries& series : form.series) {
    PlotSeries line;
    line.name = series.name;
    line.line = "solid";
    for (size_t i = 0; i < form.abscissae.size(); ++i) {
      PlotPoint point;
      point.x = form.abscissae[i];
      point.y = series.errors[i];
      line.points.push_back(std::move(point));
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

}  // namespace froth
