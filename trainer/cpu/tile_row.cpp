#include "trainer/cpu/tile_row.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <ranges>
#include <span>

#include "trainer/step/tiles.h"

namespace froth {
namespace {

// Colour over black and ln T_N; appends the places of the list that the ray met.
template <class Real>
glm::vec<4, Real> renderPixel(const RowImage<Real>& image, const std::vector<uint32_t>& ranks,
                              const TileBalls<Real>& balls, const glm::vec<3, Real>& direction,
                              std::vector<uint32_t>& met) {
  constexpr uint32_t kBlock = TileBalls<Real>::kBlock;
  glm::vec<3, Real> colour(0);
  Real logTransmittance = 0;
  const Real logCutoff = std::log(image.settings.cutoff);
  const SeenCells<Real> seen = image.cells.seen();
  for (uint32_t block = 0; block < balls.blockCount() && logTransmittance >= logCutoff; ++block) {
    uint32_t bits = balls.mayMeet(block, direction);
    for (; bits != 0 && logTransmittance >= logCutoff; bits &= bits - 1) {
      const uint32_t place = block * kBlock + static_cast<uint32_t>(std::countr_zero(bits));
      image.cells.prepare(ranks[place]);
      const SeenCell<Real>& cell = seen.cells[ranks[place]];
      const SeenDetail<Real>* details = seen.details + size_t{ranks[place]} * image.detailCount;
      Segment<Real> segment;
      if (!meetCell(cell, seen.planes + cell.planesBegin, details, image.detailCount, direction,
                    image.settings.sharpness, segment)) {
        continue;
      }
      met.push_back(place);
      const Real opticalDepth = cell.density * (segment.far - segment.near);
      colour += std::exp(logTransmittance) * foam::opacity(opticalDepth) * segment.colour;
      logTransmittance -= opticalDepth;
    }
  }
  return {colour, logTransmittance};
}

// Adds what one ray met in one cell to the sums of its row.
template <class Real>
void addSegment(const SegmentGradient<Real>& gradient, uint32_t place, TileRow<Real>& row) {
  row.cells[place] += gradient.cell;
  for (int end = 0; end < 2; ++end) {
    if (gradient.planes[end] >= kBoundedByEye) continue;
    row.pairs[row.planesBegin[place] + gradient.planes[end]] += gradient.pairs[end];
  }
}

// met: what renderPixel() found. adjoint: behind the last cell.
template <class Real>
void differentiatePixel(const RowImage<Real>& image, const std::vector<uint32_t>& ranks,
                        const std::vector<uint32_t>& places, const glm::vec<3, Real>& direction,
                        std::span<const uint32_t> met, PixelAdjoint<Real> adjoint, TileRow<Real>& row) {
  const PixelSettings<Real>& settings = image.settings;
  const SeenCells<Real> seen = image.cells.seen();
  for (const uint32_t inTile : met | std::views::reverse) {
    const SeenCell<Real>& cell = seen.cells[ranks[inTile]];
    const SeenPlane<Real>* planes = seen.planes + cell.planesBegin;
    const SeenDetail<Real>* details = seen.details + size_t{ranks[inTile]} * image.detailCount;
    const uint32_t place = places[inTile];
    Segment<Real> segment;
    if (!meetCell(cell, planes, details, image.detailCount, direction, settings.sharpness, segment)) continue;
    Real weight;
    const SegmentSeeds<Real> seeds = seedSegment(cell, segment, settings, adjoint, weight);
    const glm::vec<3, Real> miss = glm::abs(segment.colour - glm::vec<3, Real>(adjoint.wanted));
    CellSums<Real>& sums = row.cells[place];
    sums.contribution += weight * settings.perPixel;
    sums.error += weight * adjoint.wanted.w * (miss.x + miss.y + miss.z) * settings.perPixel;
    SegmentGradient<Real> gradient;
    PlainSink<Real> sink{row.details.data() + size_t{place} * image.detailCount};
    if (differentiateSegment(cell, planes, details, image.detailCount, direction, settings.sharpness, segment, seeds,
                             gradient, sink)) {
      addSegment(gradient, place, row);
    } else {
      ++row.droppedCount;
    }
  }
}

// Line by line, so that sums are added in one order.
template <class Real, class Visit>
void forEachPixel(const TrainingView<Real>& view, uint32_t tileY, Visit visit) {
  const uint32_t end = std::min((tileY + 1) * kTileSize, view.height);
  for (uint32_t y = tileY * kTileSize; y < end; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) visit(x, y, size_t{y} * view.width + x);
  }
}

}  // namespace

template <class Real>
void renderRow(const RowImage<Real>& image, uint32_t tileY, TileRow<Real>& row) {
  row.balls.resize(row.tiles.size());
  for (size_t tile = 0; tile < row.tiles.size(); ++tile) {
    row.balls[tile].take(image.cells.guardedBalls(), row.tiles[tile]);
  }
  row.met.clear();
  row.metEnds.clear();
  forEachPixel(image.view, tileY, [&](uint32_t x, uint32_t y, size_t pixel) {
    const glm::vec<3, Real> direction = directionOfPixel(image.view, x, y);
    const uint32_t tile = x / kTileSize;
    glm::vec<4, Real> shown(0);
    if (direction != glm::vec<3, Real>(0)) {
      shown = renderPixel(image, row.tiles[tile], row.balls[tile], direction, row.met);
    }
    row.metEnds.push_back(row.met.size());
    image.pixels.logTransmittances[pixel] = shown.w;
    image.pixels.rendered[pixel] = {shown.x, shown.y, shown.z, std::exp(shown.w)};
  });
}

template <class Real>
void differentiateRow(const RowImage<Real>& image, uint32_t tileY, TileRow<Real>& row) {
  row.cells.assign(row.ranks.size(), {});
  row.details.assign(row.ranks.size() * image.detailCount, {});
  row.pairs.assign(row.planesBegin.back(), glm::vec<4, Real>(0));
  row.droppedCount = 0;
  size_t metBegin = 0;
  auto metEnd = row.metEnds.begin();
  forEachPixel(image.view, tileY, [&](uint32_t x, uint32_t y, size_t pixel) {
    const std::span<const uint32_t> met = std::span(row.met).subspan(metBegin, *metEnd - metBegin);
    const uint32_t tile = x / kTileSize;
    differentiatePixel(image, row.tiles[tile], row.tilePlaces[tile], directionOfPixel(image.view, x, y), met,
                       beginAdjoint(image.pixels, pixel), row);
    metBegin = *metEnd++;
  });
}

template void renderRow(const RowImage<float>&, uint32_t, TileRow<float>&);
template void renderRow(const RowImage<double>&, uint32_t, TileRow<double>&);
template void differentiateRow(const RowImage<float>&, uint32_t, TileRow<float>&);
template void differentiateRow(const RowImage<double>&, uint32_t, TileRow<double>&);

}  // namespace froth
