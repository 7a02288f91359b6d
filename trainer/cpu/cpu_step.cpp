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
  return prepared_.seen();
}

template <class Real>
GradientSums<Real> CpuStep<Real>::sums() {
  return {cellSums_.data(), detailSums_.data(), pairSums_.data(), nullptr};
}

template <class Real>
PixelArrays<Real> CpuStep<Real>::pixels() {
  return {rendered_.data(), logTransmittances_.data(), nullptr, gradients_.data(), wanted_.data()};
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
  std::vector<uint32_t> cellOfRank;
  for (const Candidate& candidate : candidates_) cellOfRank.push_back(candidate.cell);
  prepared_.take(viewStorage(foam_), pairs_.rows(), view_, adam, cellOfRank);
  bin();
  const size_t pixelCount = size_t{view.width} * view.height;
  rendered_.resize(pixelCount);
  logTransmittances_.resize(pixelCount);
  forEachRow(&renderRow<Real>);
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

// Which rows of tiles see each cell, and then, row by row, the lists of its tiles.
template <class Real>
void CpuStep<Real>::bin() {
  const uint32_t tilesX = tilesAlong(view_.width);
  rowRanges_.resize(candidates_.size());
  tbb::parallel_for(size_t{0}, candidates_.size(), [&](size_t rank) {
    const std::span<const uint32_t> tiles = tilesOf(candidates_[rank]);
    rowRanges_[rank] = {tiles.front() / tilesX, tiles.back() / tilesX};
  });
  rowPlacesBegin_.assign(1, 0);
  for (const RowRange& range : rowRanges_) {
    rowPlacesBegin_.push_back(rowPlacesBegin_.back() + range.last - range.first + 1);
  }
  rowPlaces_.resize(rowPlacesBegin_.back());
  rows_.resize(tilesAlong(view_.height));
  tbb::parallel_for(0u, static_cast<uint32_t>(rows_.size()), [&](uint32_t tileY) { binRow(tileY); });
}

// Cells go in by rank, so every list is front to back.
template <class Real>
void CpuStep<Real>::binRow(uint32_t tileY) {
  const uint32_t tilesX = tilesAlong(view_.width);
  const uint32_t firstTile = tileY * tilesX, endTile = firstTile + tilesX;
  const SeenCell<Real>* cells = seen().cells;
  TileRow<Real>& row = rows_[tileY];
  row.ranks.clear();
  row.planesBegin.assign(1, 0);
  row.tiles.resize(tilesX);
  row.tilePlaces.resize(tilesX);
  for (auto& tile : row.tiles) tile.clear();
  for (auto& tile : row.tilePlaces) tile.clear();
  for (uint32_t rank = 0; rank < rowRanges_.size(); ++rank) {
    if (tileY < rowRanges_[rank].first || rowRanges_[rank].last < tileY) continue;
    const auto place = static_cast<uint32_t>(row.ranks.size());
    rowPlaces_[rowPlacesBegin_[rank] + tileY - rowRanges_[rank].first] = place;
    row.ranks.push_back(rank);
    row.planesBegin.push_back(row.planesBegin.back() + cells[rank].planesEnd - cells[rank].planesBegin);
    const std::span<const uint32_t> tiles = tilesOf(candidates_[rank]);
    for (auto tile = std::ranges::lower_bound(tiles, firstTile); tile != tiles.end() && *tile < endTile; ++tile) {
      row.tiles[*tile - firstTile].push_back(rank);
      row.tilePlaces[*tile - firstTile].push_back(place);
    }
  }
}

template <class Real>
void CpuStep<Real>::forEachRow(void (*pass)(const RowImage<Real>&, uint32_t, TileRow<Real>&)) {
  const RowImage<Real> image{prepared_, foam_.shape.detailCount, view_, settings_, pixels()};
  tbb::parallel_for(0u, static_cast<uint32_t>(rows_.size()), [&](uint32_t tileY) { pass(image, tileY, rows_[tileY]); });
}

template <class Real>
void CpuStep<Real>::differentiate(const std::vector<glm::vec<4, Real>>& gradients,
                                  const std::vector<glm::vec<4, Real>>& wanted) {
  gradients_ = gradients;
  wanted_ = wanted;
  forEachRow(&differentiateRow<Real>);
  reduce();
  for (const TileRow<Real>& row : rows_) droppedCount_ += row.droppedCount;
}

// The sums of all rows, by rank.
template <class Real>
void CpuStep<Real>::reduce() {
  const uint32_t detailCount = foam_.shape.detailCount;
  const SeenCell<Real>* cells = seen().cells;
  cellSums_.resize(prepared_.count());
  detailSums_.resize(size_t{prepared_.count()} * detailCount);
  pairSums_.resize(prepared_.planeCount());
  tbb::parallel_for(size_t{0}, cellSums_.size(), [&](size_t rank) {
    cellSums_[rank] = {};
    std::fill_n(&detailSums_[rank * detailCount], detailCount, DetailSums<Real>{});
    for (uint32_t e = cells[rank].planesBegin; e < cells[rank].planesEnd; ++e) pairSums_[e] = glm::vec<4, Real>(0);
    if (!(cells[rank].radius > 0)) return;  // no ray came to it
    for (uint32_t tileY = rowRanges_[rank].first; tileY <= rowRanges_[rank].last; ++tileY) {
      const TileRow<Real>& row = rows_[tileY];
      const uint32_t place = rowPlaces_[rowPlacesBegin_[rank] + tileY - rowRanges_[rank].first];
      cellSums_[rank] += row.cells[place];
      for (uint32_t k = 0; k < detailCount; ++k) {
        detailSums_[rank * detailCount + k] += row.details[size_t{place} * detailCount + k];
      }
      for (uint32_t e = row.planesBegin[place]; e < row.planesBegin[place + 1]; ++e) {
        pairSums_[cells[rank].planesBegin + e - row.planesBegin[place]] += row.pairs[e];
      }
    }
  });
}

template <class Real>
void CpuStep<Real>::update(const AdamStep<Real>& adam, Real overlapWeight) {
  const TrainedFoam<Real> foam = viewStorage(foam_);
  const SeenCells<Real> shown = seen();
  std::atomic<uint64_t> bad = 0;
  tbb::parallel_for(size_t{0}, cellSums_.size(), [&](size_t rank) {
    if (!isShown(cellSums_[rank])) return;
    const TrainedCell<Real> trained(foam, adam, shown.cells[rank].cell);
    uint32_t badHere = 0;
    for (uint32_t k = 0; k < foam.shape.detailCount; ++k) {
      const size_t detail = rank * foam.shape.detailCount + k;
      updateDetail(trained, shown.cells[rank], shown.details[detail], k, detailSums_[detail], cellSums_[rank], badHere);
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
  const SeenCells<Real> shown = seen();
  tbb::parallel_for(size_t{0}, cellSums_.size(), [&](size_t rank) {
    if (!isShown(cellSums_[rank])) return;
    const uint32_t cell = shown.cells[rank].cell;
    const TrainedCell<Real> trained(foam, adam, cell);
    for (uint32_t k = 0; k < detailCount; ++k) {
      const size_t detail = rank * detailCount + k;
      kept.details[size_t{cell} * detailCount + k] = differentiateDetail(
          trained, shown.cells[rank], shown.details[detail], k, detailSums_[detail], cellSums_[rank]);
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
