#include "trainer/cpu/cell_culling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "shaders/foam/cell.h"
#include "trainer/step/tiles.h"

namespace froth {
namespace {

// Whether any tile may see the ball. All see one without end.
template <class Real>
bool mayBeSeen(const TrainingView<Real>& view, const glm::vec<4, Real>& ball) {
  const TileRange tiles = tilesOfBall(view, glm::vec<3, Real>(ball) - view.eye, ball.w);
  return tiles.beginX < tiles.endX && tiles.beginY < tiles.endY;
}

}  // namespace

template <class Real>
void CellCulling<Real>::follow(const Balls& balls) {
  blocks_.resize((balls.size() + kBlockCells - 1) / kBlockCells);
  tbb::parallel_for(0u, static_cast<uint32_t>(blocks_.size()), [&](uint32_t block) { boundBlock(block, balls); });
}

// Balls that are no numbers do not count: no view sees them.
template <class Real>
void CellCulling<Real>::boundBlock(uint32_t block, const Balls& balls) {
  const size_t end = std::min(size_t{block + 1} * kBlockCells, balls.size());
  glm::vec<3, Real> low(std::numeric_limits<Real>::max()), high(-low);
  for (size_t cell = size_t{block} * kBlockCells; cell < end; ++cell) {
    low = glm::min(low, glm::vec<3, Real>(balls[cell]) - balls[cell].w);
    high = glm::max(high, glm::vec<3, Real>(balls[cell]) + balls[cell].w);
  }
  constexpr Real kGuard = Real(1.001);  // for what rounding takes
  blocks_[block].ball = {Real(0.5) * (low + high), kGuard * glm::length(Real(0.5) * (high - low))};
}

template <class Real>
void CellCulling<Real>::cull(const TrainingView<Real>& view, const Balls& balls) {
  const uint32_t tilesX = tilesAlong(view.width), tilesY = tilesAlong(view.height);
  Balls cones(size_t{tilesX} * tilesY);
  tbb::parallel_for(size_t{0}, cones.size(), [&](size_t tile) {
    const auto index = static_cast<uint32_t>(tile);
    cones[tile] = coneOfTile(view, index % tilesX, index / tilesX);
  });
  tbb::parallel_for(0u, static_cast<uint32_t>(blocks_.size()),
                    [&](uint32_t block) { cullBlock(block, view, balls, cones); });
  candidates_.clear();
  for (const Block& block : blocks_) {
    candidates_.insert(candidates_.end(), block.candidates.begin(), block.candidates.end());
  }
  tbb::parallel_sort(candidates_.begin(), candidates_.end(), [](const Candidate<Real>& a, const Candidate<Real>& b) {
    return std::tie(a.power, a.cell) < std::tie(b.power, b.cell);
  });
}

template <class Real>
void CellCulling<Real>::cullBlock(uint32_t index, const TrainingView<Real>& view, const Balls& balls,
                                  const Balls& cones) {
  Block& block = blocks_[index];
  block.candidates.clear();
  block.tiles.clear();
  if (!mayBeSeen(view, block.ball)) return;
  const uint32_t tilesX = tilesAlong(view.width);
  const auto end = static_cast<uint32_t>(std::min(size_t{index + 1} * kBlockCells, balls.size()));
  for (uint32_t cell = index * kBlockCells; cell < end; ++cell) {
    const glm::vec<4, Real> ball = balls[cell];
    const glm::vec<3, Real> centre = glm::vec<3, Real>(ball) - view.eye;
    const Real power = foam::powerOfOrigin(centre, ball.w);
    if (!std::isfinite(power) || !(ball.w > 0)) continue;
    if (foam::isNearCell(centre, ball.w, view.worldFromCamera[2], view.nearRatio, view.nearDepth)) continue;
    const TileRange range = tilesOfBall(view, centre, ball.w);
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
std::span<const uint32_t> CellCulling<Real>::tilesOf(const Candidate<Real>& candidate) const {
  const std::vector<uint32_t>& tiles = blocks_[candidate.cell / kBlockCells].tiles;
  return std::span(tiles).subspan(candidate.tilesBegin, candidate.tilesEnd - candidate.tilesBegin);
}

template class CellCulling<float>;
template class CellCulling<double>;

}  // namespace froth
