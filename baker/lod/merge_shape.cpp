#include "baker/lod/merge_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "baker/lod/ridge_solve.h"
#include "foam/site_tree.h"

namespace froth {
namespace {

constexpr double kShapeRidge =
    1e-3;                         // holds the site near the mean where samples lie in a plane; in units of all weight
constexpr double kCovered = 0.9;  // of the solid parts, at least
constexpr double kMostGrowth = 1.2;   // of the ball round both balls
constexpr double kLeastCosine = 0.1;  // below, the normals have no mean

struct WeightedPoint {
  glm::dvec3 place;  // from the mean
  double weight;
  double power;  // the lesser of both
};

std::vector<WeightedPoint> weighSolid(const Foam& cells, const MergeParts& parts, const glm::dvec3& mean) {
  std::vector<WeightedPoint> points;
  const double volume = parts[0].samples.solidVolume + parts[1].samples.solidVolume;
  for (const MergePart& part : parts) {
    const double weight = part.samples.solidVolume / (volume * double(part.samples.solid.size()));
    for (const glm::dvec3& x : part.samples.solid) {
      const glm::dvec3 place = part.offset + x;
      double power = INFINITY;
      for (const MergePart& either : parts) {
        const glm::dvec3 toSite = either.offset - place;
        power = std::min(power, foam::powerOfOrigin(toSite, double{cells.radii[either.cell]}));
      }
      points.push_back({place - mean, weight, power});
    }
  }
  return points;
}

double ballRoundBoth(const Foam& cells, const MergeParts& parts) {
  const double a = cells.radii[parts[0].cell], b = cells.radii[parts[1].cell];
  const double distance = glm::distance(parts[0].offset, parts[1].offset);
  return std::max({a, b, 0.5 * (distance + a + b)});
}

// power - |y|^2 = k + s . y of a ball: its centre -s/2, its squared radius |s|^2/4 - k.
glm::dvec3 fitCentre(const std::vector<WeightedPoint>& points, double size) {
  std::array<double, 16> matrix{};
  std::array<double, 4> right{};
  for (const WeightedPoint& point : points) {
    const std::array<double, 4> row{1, point.place.x / size, point.place.y / size, point.place.z / size};
    const double wanted = (point.power - glm::dot(point.place, point.place)) / (size * size);
    for (size_t i = 0; i < 4; ++i) {
      right[i] += point.weight * row[i] * wanted;
      for (size_t j = i; j < 4; ++j) matrix[4 * i + j] += point.weight * row[i] * row[j];
    }
  }
  for (size_t i = 1; i < 4; ++i) matrix[5 * i] += kShapeRidge;
  if (!solveDefinite(matrix, right, 4, 1)) return glm::dvec3(0);
  return -0.5 * size * glm::dvec3(right[1], right[2], right[3]);
}

// The radius whose power fits best around `centre`, within the limits.
double fitRadius(const std::vector<WeightedPoint>& points, const glm::dvec3& centre, double most) {
  double squared = 0;
  std::vector<std::pair<double, double>> distances;  // squared, with weights
  for (const WeightedPoint& point : points) {
    const glm::dvec3 from = point.place - centre;
    distances.emplace_back(glm::dot(from, from), point.weight);
    squared += point.weight * (distances.back().first - point.power);
  }
  std::sort(distances.begin(), distances.end());
  double covered = 0, reach = 0;
  for (const auto& [distance, weight] : distances) {
    if (covered >= kCovered) break;
    covered += weight;
    reach = distance;
  }
  return std::min(std::sqrt(std::max({squared, reach, 1e-4 * most * most})), most);
}

FaceFrame<double> meanFrame(const Foam& cells, const MergeParts& parts) {
  const auto& heavier = parts[parts[1].weight > parts[0].weight];
  FaceFrame<double> frame = faceFrame<double>(cells.orientations[heavier.cell]);
  glm::dvec3 sum(0);
  for (const MergePart& part : parts) {
    sum += part.weight * faceFrame<double>(cells.orientations[part.cell]).normal;
  }
  if (glm::length(sum) < kLeastCosine) sum = frame.normal;
  frame.normal = glm::normalize(sum);
  frame.tangent = glm::normalize(frame.tangent - glm::dot(frame.tangent, frame.normal) * frame.normal);
  frame.bitangent = glm::cross(frame.normal, frame.tangent);
  return frame;
}

// Where the faces lie along the normal.
double meanFace(const MergeParts& parts, const glm::dvec3& normal) {
  double sum = 0;
  for (const MergePart& part : parts) {
    for (const glm::dvec3& x : part.samples.face) {
      sum += part.weight / double(part.samples.face.size()) * glm::dot(normal, part.offset + x);
    }
  }
  return sum;
}

}  // namespace

MergedShape mergeShape(const Foam& cells, const MergeParts& parts, bool keepsPlain) {
  const glm::dvec3 mean = parts[0].weight * parts[0].offset + parts[1].weight * parts[1].offset;
  const std::vector<WeightedPoint> points = weighSolid(cells, parts, mean);
  const double size = ballRoundBoth(cells, parts);
  MergedShape shape;
  shape.frame = meanFrame(cells, parts);
  glm::dvec3 centre = fitCentre(points, size);
  if (keepsPlain) {
    const glm::dvec3 normal = shape.frame.normal;
    centre += (meanFace(parts, normal) - glm::dot(normal, mean + centre)) * normal;
  }
  shape.site = mean + centre;
  shape.radius = fitRadius(points, centre, kMostGrowth * size);
  for (const MergePart& part : parts) {
    shape.opticalVolume += double{cells.densities[part.cell]} * part.samples.solidVolume;
  }
  return shape;
}

}  // namespace froth
