#include "baker/lod/solid_samples.h"

#include <array>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "baker/lod/detail_sharpness.h"
#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr size_t kBallPoints = 96, kFacePoints = 32;

// Shells of equal volume on a spiral; the golden ratio spreads the shells over the spiral.
std::array<glm::dvec3, kBallPoints> pointsInBall() {
  std::array<glm::dvec3, kBallPoints> points;
  for (size_t i = 0; i < kBallPoints; ++i) {
    const double count = kBallPoints, z = 1 - (2 * double(i) + 1) / count;
    const double angle = double(i) * glm::pi<double>() * (3 - std::sqrt(5.0)), side = std::sqrt(1 - z * z);
    const double radius = std::cbrt(glm::fract(double(i) * 0.6180339887498949 + 0.5 / count));
    points[i] = radius * glm::dvec3(side * std::cos(angle), side * std::sin(angle), z);
  }
  return points;
}

std::array<glm::dvec2, kFacePoints> pointsInDisc() {
  std::array<glm::dvec2, kFacePoints> points;
  for (size_t i = 0; i < kFacePoints; ++i) {
    const double radius = std::sqrt((double(i) + 0.5) / kFacePoints);
    const double angle = double(i) * glm::pi<double>() * (3 - std::sqrt(5.0));
    points[i] = radius * glm::dvec2(std::cos(angle), std::sin(angle));
  }
  return points;
}

// The half-spaces of one cell, in its face's frame and units of its radius.
class CellBody {
 public:
  CellBody(const Foam& foam, const CellGraph& pairs, uint32_t cell) : foam_(foam), cell_(cell) {
    frame = faceFrame<double>(foam.orientations[cell]);
    radius = foam.radii[cell];
    for (const uint32_t other : neighboursOf(pairs, cell)) {
      const glm::dvec3 toOther = (glm::dvec3(foam.sites[other]) - glm::dvec3(foam.sites[cell])) / radius;
      if (toOther == glm::dvec3(0)) continue;
      const double offset = foam::radicalOffset(toOther, 1.0, foam.radii[other] / radius);
      planes_.push_back({glm::dot(toOther, frame.tangent), glm::dot(toOther, frame.bitangent),
                         glm::dot(toOther, frame.normal), offset});
    }
  }

  bool holds(const glm::dvec3& x) const {
    if (glm::dot(x, x) > 1) return false;
    for (const glm::dvec4& plane : planes_) {
      if (glm::dot(glm::dvec3(plane), x) > plane.w) return false;
    }
    return true;
  }

  // Height of the face over (u, v) [radii], and the shares of the detail sites there.
  double heightAt(const glm::dvec2& place, double* shares) const {
    const uint32_t K = foam_.detailCount;
    const size_t first = size_t{cell_} * K;
    double sum = 0, height = 0;
    for (uint32_t k = 0; k < K; ++k) {
      shares[k] = foam::detailWeight(glm::dvec3(place, 0), glm::dvec2(foam_.detailSites[first + k]), kTrainedSharpness);
      sum += shares[k];
    }
    sum = foam::flooredWeightSum(sum);
    for (uint32_t k = 0; k < K; ++k) height += (shares[k] /= sum) * foam_.detailHeights[first + k];
    return height;
  }

  glm::dvec3 toWorld(const glm::dvec3& x) const {
    return radius * (x.x * frame.tangent + x.y * frame.bitangent + x.z * frame.normal);
  }

  FaceFrame<double> frame;
  double radius;

 private:
  const Foam& foam_;
  const uint32_t cell_;
  std::vector<glm::dvec4> planes_;  // xyz . x <= w
};

}  // namespace

CellSamples CellSampler::sample(uint32_t cell) const {
  static const std::array<glm::dvec3, kBallPoints> ball = pointsInBall();
  static const std::array<glm::dvec2, kFacePoints> disc = pointsInDisc();
  const CellBody body(foam_, pairs_, cell);
  CellSamples samples;
  std::vector<double> shares(foam_.detailCount);
  const double ballVolume = 4.0 / 3 * glm::pi<double>() * body.radius * body.radius * body.radius;
  for (const glm::dvec3& x : ball) {
    if (body.holds(x) && x.z <= body.heightAt(glm::dvec2(x), shares.data())) samples.solid.push_back(body.toWorld(x));
  }
  samples.solidVolume = ballVolume * std::max(double(samples.solid.size()), 0.5) / kBallPoints;
  if (samples.solid.empty()) samples.solid.push_back(glm::dvec3(0));
  // A face that no sample finds in the cell is taken whole.
  for (const bool isCut : {true, false}) {
    if (!samples.face.empty()) break;
    for (const glm::dvec2& place : disc) {
      const double height = body.heightAt(place, shares.data());
      if (isCut && !body.holds({place, height})) continue;
      samples.face.push_back(body.toWorld({place, height}));
      samples.shares.insert(samples.shares.end(), shares.begin(), shares.end());
    }
  }
  return samples;
}

}  // namespace froth
