// Which tiles of the image a ball can be seen in. Tests err to the side of more tiles.
#pragma once

#include <cmath>
#include <cstdint>

#include "shaders/foam/cones.h"
#include "shaders/foam/rays.h"
#include "trainer/step/training_view.h"

namespace froth {

inline constexpr uint32_t kTileSize = 8;  // [pixels] of a side

FROTH_HD uint32_t tilesAlong(uint32_t pixels) { return (pixels + kTileSize - 1) / kTileSize; }

// Tiles [begin, end) in x and y.
struct TileRange {
  uint32_t beginX, endX, beginY, endY;
};

// Around the rays of a tile's pixels.
template <class Real>
FROTH_HD glm::vec<4, Real> coneOfTile(const TrainingView<Real>& view, uint32_t tileX, uint32_t tileY) {
  const uint32_t endX = (tileX + 1) * kTileSize < view.width ? (tileX + 1) * kTileSize : view.width;
  const uint32_t endY = (tileY + 1) * kTileSize < view.height ? (tileY + 1) * kTileSize : view.height;
  glm::vec<3, Real> sum(0);
  for (uint32_t y = tileY * kTileSize; y < endY; ++y) {
    for (uint32_t x = tileX * kTileSize; x < endX; ++x) sum += directionOfPixel(view, x, y);
  }
  const Real length = std::sqrt(glm::dot(sum, sum));
  if (!(length > 0)) return {0, 0, 1, Real(foam::kConeOfNone)};
  const glm::vec<3, Real> axis = sum / length;
  Real longest = 0;
  for (uint32_t y = tileY * kTileSize; y < endY; ++y) {
    for (uint32_t x = tileX * kTileSize; x < endX; ++x) {
      const glm::vec<3, Real> direction = directionOfPixel(view, x, y);
      if (direction == glm::vec<3, Real>(0)) continue;
      const glm::vec<3, Real> difference = direction - axis;
      const Real squared = glm::dot(difference, difference);
      longest = squared > longest ? squared : longest;
    }
  }
  return foam::coneOfChord(axis, std::sqrt(longest));
}

// Tiles of one axis whose pixel centres lie between two tangents; none: end <= begin.
template <class Real>
FROTH_HD void tilesBetween(Real low, Real high, Real focal, Real centre, uint32_t pixels, uint32_t& begin,
                           uint32_t& end) {
  const Real size = Real(kTileSize), last = Real(pixels);
  const Real first = std::fmin(std::fmax(low * focal + centre, Real(0)), last);
  const Real past = std::fmin(std::fmax(high * focal + centre, Real(0)), last);
  begin = static_cast<uint32_t>(std::floor(first / size));
  end = static_cast<uint32_t>(std::ceil(past / size));
}

// A box of tiles that holds the ball's image: all tiles for lenses that are no pinholes, and where the eye is in the
// ball. centre: relative to the eye.
template <class Real>
FROTH_HD TileRange tilesOfBall(const TrainingView<Real>& view, const glm::vec<3, Real>& centre, Real radius) {
  TileRange range{0, tilesAlong(view.width), 0, tilesAlong(view.height)};
  if (view.directions) return range;
  const glm::vec<3, Real> right = view.worldFromCamera[0], down = view.worldFromCamera[1];
  const glm::vec<3, Real> forward = view.worldFromCamera[2];
  if (glm::dot(forward, centre) + foam::guardedRadius(centre, radius) <= 0) return {0, 0, 0, 0};
  Real low, high;
  if (foam::boundBallImage(centre, radius, right, -forward, low, high)) {
    tilesBetween(low, high, view.fx, view.cx, view.width, range.beginX, range.endX);
  }
  if (foam::boundBallImage(centre, radius, down, -forward, low, high)) {
    tilesBetween(low, high, view.fy, view.cy, view.height, range.beginY, range.endY);
  }
  return range;
}

}  // namespace froth
