#include "baker/lod/group_error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "baker/lod/parallel_raster.h"

namespace froth {
namespace {

constexpr uint32_t kErrorDirections = 14;
constexpr uint32_t kErrorRays = 96;                                                // per side
constexpr std::array<uint32_t, 9> kRaysPerPixel = {1, 2, 3, 4, 6, 8, 12, 16, 24};  // per side; divide kErrorRays

using Squares = std::array<double, kRaysPerPixel.size()>;

float coverage(const ParallelImage& image, size_t ray) { return -std::expm1(image.logTransmittances[ray]); }

// Mean squared difference of pixels of so many rays per side, over black and over white.
double differenceAt(const ParallelImage& fine, const ParallelImage& coarse, uint32_t rays, double covered) {
  const uint32_t size = kErrorRays / rays;
  double sum = 0;
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      glm::dvec3 colour(0);
      double alpha = 0;
      for (uint32_t ray = 0; ray < rays * rays; ++ray) {
        const size_t place = size_t{y * rays + ray / rays} * kErrorRays + x * rays + ray % rays;
        colour += glm::dvec3(fine.colours[place]) - glm::dvec3(coarse.colours[place]);
        alpha += double{coverage(fine, place)} - double{coverage(coarse, place)};
      }
      const glm::dvec3 overWhite = colour - alpha;
      sum += 0.5 * (glm::dot(colour, colour) + glm::dot(overWhite, overWhite));
    }
  }
  // A pixel's difference is the sum over its rays / rays^2, and it covers rays^2 of `covered`.
  return sum / (3 * covered * rays * rays);
}

Squares differencesAlong(const ParallelRaster& fine, const ParallelRaster& coarse, const RayGrid& grid) {
  const ParallelImage first = fine.draw(grid), second = coarse.draw(grid);
  double covered = 0;
  for (size_t ray = 0; ray < first.colours.size(); ++ray) {
    covered += std::max(coverage(first, ray), coverage(second, ray));
  }
  Squares squares{};
  if (!(covered > 0)) return squares;
  for (size_t i = 0; i < squares.size(); ++i) {
    squares[i] = differenceAt(first, second, kRaysPerPixel[i], covered);
  }
  return squares;
}

}  // namespace

std::vector<ErrorAtSize> measureErrorCurve(const Foam& fine, const Foam& coarse, uint64_t seed,
                                           std::span<const glm::vec3> eyes) {
  const FoamBall bound = boundVisibleCells(fine);
  if (bound.radius == 0) return {};
  const std::vector<RayGrid> grids = makeGrids(bound, eyes, kErrorDirections, kErrorRays, seed);
  const ParallelRaster first(fine, bound.centre), second(coarse, bound.centre);
  std::vector<Squares> found(grids.size());
  tbb::parallel_for(size_t{0}, grids.size(), [&](size_t i) { found[i] = differencesAlong(first, second, grids[i]); });
  std::vector<ErrorAtSize> curve;
  for (size_t i = 0; i < kRaysPerPixel.size(); ++i) {
    double worst = 0;
    for (const Squares& squares : found) worst = std::max(worst, squares[i]);
    curve.push_back({2 * bound.radius * kRaysPerPixel[i] / kErrorRays, worst});
  }
  return curve;
}

double measureGroupError(const Foam& fine, const Foam& coarse, uint64_t seed, std::span<const glm::vec3> eyes) {
  const std::vector<ErrorAtSize> curve = measureErrorCurve(fine, coarse, seed, eyes);
  const double allowed = std::pow(10.0, -kGroupPsnr / 10);
  size_t after = curve.size();
  while (after > 0 && curve[after - 1].worst <= allowed) --after;
  // Outside of the curve: errors of single rays average out over a pixel, so squares fall as its area grows.
  const auto alone = [&](const ErrorAtSize& known) { return known.pixel * std::sqrt(known.worst / allowed); };
  if (curve.empty()) return 0;
  if (after == 0) return alone(curve.front());
  if (after == curve.size()) return alone(curve.back());
  const ErrorAtSize &over = curve[after - 1], &under = curve[after];
  if (under.worst == 0) return under.pixel;
  const double share = std::log(over.worst / allowed) / std::log(over.worst / under.worst);
  return over.pixel * std::pow(under.pixel / over.pixel, share);
}

}  // namespace froth
