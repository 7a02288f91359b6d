#include "trainer/cpu/cpu_step.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "trainer/step/cell_update.h"
#include "trainer/step/tiles.h"

namespace froth {

template <class Real>
SeenCells<Real> CpuStep<Real>::seen() {
  return {static_cast<uint32_t>(cells_.size()), cells_.data(), planes_.data(), details_.data(), rankOf_.data()};
}

template <class Real>
GradientSums<Real> CpuStep<Real>::sums() {
  return {cellSums_.data(), detailSums_.data(), pairSums_.data(), nullptr};
}

template <class Real>
PixelArrays<Real> CpuStep<Real>::pixels() {
  return {rendered_.data(), logTransmittances_.data(), ends_.data(), gradients_.data(), wanted_.data()};
}

template <class Real>
void CpuStep<Real>::activate(float leastSkin) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  tbb::parallel_for(0u, foam.shape.cellCount, [&](uint32_t cell) { foam.balls[cell] = ballOf(foam, cell); });
  blocks_.resize((foam.shape.cellCount + kBlockCells - 1) / kBlockCells);
  tbb::parallel_for(0u, static_cast<uint32_t>(blocks_.size()), [&](uint32_t block) { boundBlock(block); });
  pairs_.follow(foam_.balls, leastSkin);
}

template <class Real>
const std::vector<glm::vec<4, Real>>& CpuStep<Real>::render(const TrainingView<Real>& view,
                                                            const PixelSettings<Real>& settings,
                                                            const AdamStep<Real>& adam) {
  view_ = view;
  settings_ = settings;
  cull();
  prepare(adam);
  bin();
  const size_t pixelCount = size_t{view.width} * view.height;
  rendered_.resize(pixelCount);
  logTransmittances_.resize(pixelCount);
  ends_.resize(pixelCount);
  tbb::parallel_for(0u, tilesAlong(view.height), [&](uint32_t tileY) { renderRow(tileY); });
  return rendered_;
}

// Balls that are no numbers do not count: no view sees them.
template <class Real>
void CpuStep<Real>::boundBlock(uint32_t block) {
  const uint32_t end = std::min((block + 1) * kBlockCells, foam_.shape.cellCount);
  glm::vec<3, Real> low(std::numeric_limits<Real>::max()), high(-low);
  for (uint32_t cell = block * kBlockCells; cell < end; ++cell) {
    const glm::vec<4, Real>& ball = foam_.balls[cell];
    low = glm::min(low, glm::vec<3, Real>(ball) - ball.w);
    high = glm::max(high, glm::vec<3, Real>(ball) + ball.w);
  }
  constexpr Real kGuard = Real(1.001);  // for what rounding takes
  blocks_[block].ball = {Real(0.5) * (low + high), kGuard * glm::length(Real(0.5) * (high - low))};
}

// Those that the view sees, front to back, equals by index.
template <class Real>
void CpuStep<Real>::cull() {
  const uint32_t tilesX = tilesAlong(view_.width), tilesY = tilesAlong(view_.height);
  std::vector<glm::vec<4, Real>> cones(size_t{tilesX} * tilesY);
  tbb::parallel_for(size_t{0}, cones.size(), [&](size_t tile) {
    const auto index = static_cast<uint32_t>(tile);
    cones[tile] = coneOfTile(view_, index % tilesX, index / tilesX);
  });
  tbb::parallel_for(0u, static_cast<uint32_t>(blocks_.size()), [&](uint32_t block) { cullBlock(block, cones); });
  candidates_.clear();
  for (const CellBlock& block : blocks_) {
    candidates_.insert(candidates_.end(), block.candidates.begin(), block.candidates.end());
  }
  tbb::parallel_sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.power, a.cell) < std::tie(b.power, b.cell);
  });
}

// Whether any tile may see the ball. All see one without end.
template <class Real>
static bool mayBeSeen(const TrainingView<Real>& view, const glm::vec<4, Real>& ball) {
  const TileRange tiles = tilesOfBall(view, glm::vec<3, Real>(ball) - view.eye, ball.w);
  return tiles.beginX < tiles.endX && tiles.beginY < tiles.endY;
}

// Near tests, and the tiles that see each ball.
template <class Real>
void CpuStep<Real>::cullBlock(uint32_t index, const std::vector<glm::vec<4, Real>>& cones) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  CellBlock& block = blocks_[index];
  block.candidates.clear();
  block.tiles.clear();
  if (!mayBeSeen(view_, block.ball)) return;
  const uint32_t tilesX = tilesAlong(view_.width);
  const uint32_t end = std::min((index + 1) * kBlockCells, foam.shape.cellCount);
  for (uint32_t cell = index * kBlockCells; cell < end; ++cell) {
    const glm::vec<4, Real> ball = foam.balls[cell];
    const glm::vec<3, Real> centre = glm::vec<3, Real>(ball) - view_.eye;
    const Real power = foam::powerOfOrigin(centre, ball.w);
    if (!std::isfinite(power) || !(ball.w > 0)) continue;
    if (foam::isNearCell(centre, ball.w, view_.worldFromCamera[2], view_.nearRatio, view_.nearDepth)) continue;
    const TileRange range = tilesOfBall(view_, centre, ball.w);
    const Real radius = foam::guardedRadius(centre, ball.w);
    const auto begin = static_cast<uint32_t>(block.tiles.size());
    for (uint32_t tileY = range.beginY; tileY < range.endY; ++tileY) {
      for (uint32_t tile = tileY * tilesX + range.beginX; tile < tileY * tilesX + range.endX; ++tile) {
        if (foam::coneMeetsBall(cones[tile], centre, radius)) block.tiles.push_back(tile);
      }
    }
    const auto tilesEnd = static_cast<uint32_t>(block.tiles.size());
    if (begin < tilesEnd) block.candidates.push_back({power, cell, begin, tilesEnd});
  }
}

template <class Real>
std::span<const uint32_t> CpuStep<Real>::tilesOf(const Candidate& candidate) const {
  const std::vector<uint32_t>& tiles = blocks_[candidate.cell / kBlockCells].tiles;
  return std::span(tiles).subspan(candidate.tilesBegin, candidate.tilesEnd - candidate.tilesBegin);
}

template <class Real>
void CpuStep<Real>::prepare(const AdamStep<Real>& adam) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  const NeighbourRows rows = pairs_.rows();
  cells_.resize(candidates_.size());
  details_.resize(cells_.size() * foam.shape.detailCount);
  rankOf_.assign(foam.shape.cellCount, SeenCells<Real>::kNotSeen);
  uint32_t planeCount = 0;
  for (uint32_t rank = 0; rank < cells_.size(); ++rank) {
    const uint32_t cell = candidates_[rank].cell;
    rankOf_[cell] = rank;
    cells_[rank].planesBegin = planeCount;
    planeCount += rows.offsets[cell + 1] - rows.offsets[cell];
    cells_[rank].planesEnd = planeCount;
  }
  planes_.resize(planeCount);
  const auto prepareOne = [&](uint32_t cell) {
    const uint32_t rank = rankOf_[cell];
    SeenCell<Real>& prepared = cells_[rank];
    const TrainedCell<Real> trained(foam, adam, cell);
    prepareCell(trained, view_.eye, prepared);
    for (uint32_t e = rows.offsets[cell]; e < rows.offsets[cell + 1]; ++e) {
      planes_[prepared.planesBegin + e - rows.offsets[cell]] = preparePlane(foam, view_, cell, rows.neighbours[e]);
    }
    for (uint32_t k = 0; k < foam.shape.detailCount; ++k) {
      details_[size_t{rank} * foam.shape.detailCount + k] = prepareDetail(trained, prepared, k);
    }
  };
  // In the order of the foam: its parameters are most of what is read.
  tbb::parallel_for(size_t{0}, blocks_.size(), [&](size_t block) {
    for (const Candidate& candidate : blocks_[block].candidates) prepareOne(candidate.cell);
  });
}

// Cells go in by rank, so every list is front to back.
template <class Real>
void CpuStep<Real>::bin() {
  const uint32_t tilesX = tilesAlong(view_.width);
  rows_.resize(tilesAlong(view_.height));
  for (TileRow<Real>& row : rows_) {
    row.ranks.clear();
    row.planesBegin.assign(1, 0);
    row.tiles.resize(tilesX);
    row.tilePlaces.resize(tilesX);
    for (auto& tile : row.tiles) tile.clear();
    for (auto& tile : row.tilePlaces) tile.clear();
  }
  rowPlaces_.clear();
  rowPlacesBegin_.assign(1, 0);
  for (uint32_t rank = 0; rank < cells_.size(); ++rank) {
    uint32_t lastRow = UINT32_MAX;
    for (const uint32_t tile : tilesOf(candidates_[rank])) {
      const uint32_t tileY = tile / tilesX;
      TileRow<Real>& row = rows_[tileY];
      if (tileY != lastRow) {
        rowPlaces_.push_back({tileY, static_cast<uint32_t>(row.ranks.size())});
        row.ranks.push_back(rank);
        row.planesBegin.push_back(row.planesBegin.back() + cells_[rank].planesEnd - cells_[rank].planesBegin);
        lastRow = tileY;
      }
      row.tiles[tile % tilesX].push_back(rank);
      row.tilePlaces[tile % tilesX].push_back(rowPlaces_.back().place);
    }
    rowPlacesBegin_.push_back(rowPlaces_.size());
  }
}

template <class Real>
void CpuStep<Real>::renderRow(uint32_t tileY) {
  const SeenCells<Real> cells = seen();
  for (uint32_t y = tileY * kTileSize; y < std::min((tileY + 1) * kTileSize, view_.height); ++y) {
    for (uint32_t x = 0; x < view_.width; ++x) {
      const size_t pixel = size_t{y} * view_.width + x;
      const std::vector<uint32_t>& ranks = rows_[tileY].tiles[x / kTileSize];
      const glm::vec<3, Real> direction = directionOfPixel(view_, x, y);
      const bool hasRay = direction != glm::vec<3, Real>(0);
      const glm::vec<4, Real> shown =
          renderPixel(cells, foam_.shape.detailCount, ranks.data(), hasRay ? static_cast<uint32_t>(ranks.size()) : 0,
                      direction, settings_, ends_[pixel]);
      logTransmittances_[pixel] = shown.w;
      rendered_[pixel] = {shown.x, shown.y, shown.z, std::exp(shown.w)};
    }
  }
}

template <class Real>
void CpuStep<Real>::differentiate(const std::vector<glm::vec<4, Real>>& gradients,
                                  const std::vector<glm::vec<4, Real>>& wanted) {
  gradients_ = gradients;
  wanted_ = wanted;
  tbb::parallel_for(0u, static_cast<uint32_t>(rows_.size()), [&](uint32_t tileY) { differentiateRow(tileY); });
  reduce();
  for (const TileRow<Real>& row : rows_) droppedCount_ += row.droppedCount;
}

// Adds what one ray met in one cell to the sums of its row.
template <class Real>
static void addSegment(const SegmentGradient<Real>& gradient, const SeenCell<Real>& cell, uint32_t place,
                       TileRow<Real>& row) {
  row.cells[place] += gradient.cell;
  for (int end = 0; end < 2; ++end) {
    if (gradient.planes[end] >= kBoundedByEye) continue;
    row.pairs[row.planesBegin[place] + gradient.planes[end] - cell.planesBegin] += gradient.pairs[end];
  }
}

template <class Real>
static void differentiatePixel(const SeenCells<Real>& seen, uint32_t detailCount, const glm::vec<3, Real>& direction,
                               const PixelSettings<Real>& settings, const std::vector<uint32_t>& ranks,
                               const std::vector<uint32_t>& places, uint32_t end, PixelAdjoint<Real> adjoint,
                               TileRow<Real>& row) {
  while (end-- > 0) {
    const SeenCell<Real>& cell = seen.cells[ranks[end]];
    const SeenDetail<Real>* details = seen.details + size_t{ranks[end]} * detailCount;
    Segment<Real> segment;
    if (!meetCell(cell, seen.planes, details, detailCount, direction, settings.sharpness, segment)) continue;
    Real weight;
    const SegmentSeeds<Real> seeds = seedSegment(cell, segment, settings, adjoint, weight);
    const glm::vec<3, Real> miss = glm::abs(segment.colour - glm::vec<3, Real>(adjoint.wanted));
    CellSums<Real>& sums = row.cells[places[end]];
    sums.contribution += weight * settings.perPixel;
    sums.error += weight * adjoint.wanted.w * (miss.x + miss.y + miss.z) * settings.perPixel;
    SegmentGradient<Real> gradient;
    PlainSink<Real> sink{row.details.data() + size_t{places[end]} * detailCount};
    if (differentiateSegment(cell, seen.planes, details, detailCount, direction, settings.sharpness, segment, seeds,
                             gradient, sink)) {
      addSegment(gradient, cell, places[end], row);
    } else {
      ++row.droppedCount;
    }
  }
}

template <class Real>
void CpuStep<Real>::differentiateRow(uint32_t tileY) {
  TileRow<Real>& row = rows_[tileY];
  row.cells.assign(row.ranks.size(), {});
  row.details.assign(row.ranks.size() * foam_.shape.detailCount, {});
  row.pairs.assign(row.planesBegin.back(), glm::vec<4, Real>(0));
  row.droppedCount = 0;
  for (uint32_t y = tileY * kTileSize; y < std::min((tileY + 1) * kTileSize, view_.height); ++y) {
    for (uint32_t x = 0; x < view_.width; ++x) {
      const size_t pixel = size_t{y} * view_.width + x;
      differentiatePixel(seen(), foam_.shape.detailCount, directionOfPixel(view_, x, y), settings_,
                         row.tiles[x / kTileSize], row.tilePlaces[x / kTileSize], ends_[pixel],
                         beginAdjoint(pixels(), pixel), row);
    }
  }
}

// The sums of all rows, by rank.
template <class Real>
void CpuStep<Real>::reduce() {
  const uint32_t detailCount = foam_.shape.detailCount;
  cellSums_.resize(cells_.size());
  detailSums_.resize(details_.size());
  pairSums_.resize(planes_.size());
  tbb::parallel_for(size_t{0}, cells_.size(), [&](size_t rank) {
    cellSums_[rank] = {};
    std::fill_n(&detailSums_[rank * detailCount], detailCount, DetailSums<Real>{});
    for (uint32_t e = cells_[rank].planesBegin; e < cells_[rank].planesEnd; ++e) pairSums_[e] = glm::vec<4, Real>(0);
    for (size_t i = rowPlacesBegin_[rank]; i < rowPlacesBegin_[rank + 1]; ++i) {
      const TileRow<Real>& row = rows_[rowPlaces_[i].row];
      const uint32_t place = rowPlaces_[i].place;
      cellSums_[rank] += row.cells[place];
      for (uint32_t k = 0; k < detailCount; ++k) {
        detailSums_[rank * detailCount + k] += row.details[size_t{place} * detailCount + k];
      }
      for (uint32_t e = row.planesBegin[place]; e < row.planesBegin[place + 1]; ++e) {
        pairSums_[cells_[rank].planesBegin + e - row.planesBegin[place]] += row.pairs[e];
      }
    }
  });
}

template <class Real>
void CpuStep<Real>::update(const AdamStep<Real>& adam, Real overlapWeight) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  std::atomic<uint64_t> bad = 0;
  tbb::parallel_for(size_t{0}, cells_.size(), [&](size_t rank) {
    if (!isShown(cellSums_[rank])) return;
    const TrainedCell<Real> trained(foam, adam, cells_[rank].cell);
    uint32_t badHere = 0;
    for (uint32_t k = 0; k < foam.shape.detailCount; ++k) {
      const size_t detail = rank * foam.shape.detailCount + k;
      updateDetail(trained, cells_[rank], details_[detail], k, detailSums_[detail], cellSums_[rank], badHere);
    }
    updateShownCell(trained, cellSums_[rank], badHere);
    bad += badHere;
  });
  tbb::parallel_for(0u, foam.shape.cellCount, [&](uint32_t cell) {
    uint32_t badHere = 0;
    updateBall(foam, adam, cell, gradientOfBall(cell, adam.eyes, overlapWeight), badHere);
    updateMeans(foam, cell, sumsOfCell(seen(), sums(), cell));
    bad += badHere;
  });
  droppedCount_ += bad;
}

template <class Real>
glm::vec<4, Real> CpuStep<Real>::gradientOfBall(uint32_t cell, const Eyes& eyes, Real overlapWeight) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  const NeighbourRows rows = pairs_.rows();
  const Real weight = overlapWeightAt(eyes, foam.balls[cell], overlapWeight);
  glm::vec<4, Real> gradient = gradientOfOwnSums(sumsOfCell(seen(), sums(), cell));
  for (uint32_t e = rows.offsets[cell]; e < rows.offsets[cell + 1]; ++e) {
    gradient += gradientOfPair(foam, rows, seen(), sums(), weight, cell, e);
  }
  return gradient;
}

template <class Real>
void CpuStep<Real>::keepGradients(const AdamStep<Real>& adam, Real overlapWeight) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  const uint32_t detailCount = foam.shape.detailCount;
  KeptView& kept = keptViews_.emplace_back();
  kept.eye = view_.eye;
  kept.cells.resize(foam.shape.cellCount);
  kept.details.resize(size_t{foam.shape.cellCount} * detailCount);
  tbb::parallel_for(size_t{0}, cells_.size(), [&](size_t rank) {
    if (!isShown(cellSums_[rank])) return;
    const uint32_t cell = cells_[rank].cell;
    const TrainedCell<Real> trained(foam, adam, cell);
    for (uint32_t k = 0; k < detailCount; ++k) {
      const size_t detail = rank * detailCount + k;
      kept.details[size_t{cell} * detailCount + k] =
          differentiateDetail(trained, cells_[rank], details_[detail], k, detailSums_[detail], cellSums_[rank]);
    }
  });
  tbb::parallel_for(0u, foam.shape.cellCount, [&](uint32_t cell) {
    kept.cells[cell] = keepCell(sumsOfCell(seen(), sums(), cell), gradientOfBall(cell, adam.eyes, overlapWeight));
  });
}

template <class Real>
void CpuStep<Real>::updateByViews(const AdamStep<Real>& adam) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  std::vector<ViewGradients<Real>> views;
  for (KeptView& kept : keptViews_) views.push_back({kept.eye, kept.cells.data(), kept.details.data()});
  const auto viewCount = static_cast<uint32_t>(views.size());
  std::atomic<uint64_t> bad = 0;
  tbb::parallel_for(0u, foam.shape.cellCount, [&](uint32_t cell) {
    uint32_t badHere = 0;
    const CellSums<Real> mean = meanOfCell(views.data(), viewCount, cell);
    if (isShown(mean)) {
      const TrainedCell<Real> trained(foam, adam, cell);
      for (uint32_t k = 0; k < foam.shape.detailCount; ++k) {
        updateDetailByViews(trained, views.data(), viewCount, k, badHere);
      }
      updateShownCell(trained, mean, badHere);
    }
    updateBallByViews(foam, adam, views.data(), viewCount, cell, badHere);
    bad += badHere;
  });
  droppedCount_ += bad;
  keptViews_.clear();
}

template class CpuStep<float>;
template class CpuStep<double>;

}  // namespace froth
