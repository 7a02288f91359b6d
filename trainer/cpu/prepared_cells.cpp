#include "trainer/cpu/prepared_cells.h"

#include <atomic>

#include <tbb/parallel_for.h>

#include "shaders/foam/rays.h"

namespace froth {
namespace {

template <class Item>
void growTo(std::vector<Item>& items, size_t count) {
  if (items.size() < count) items.resize(count);
}

}  // namespace

template <class Real>
void PreparedCells<Real>::take(const TrainedFoam<Real>& foam, const NeighbourRows& rows, const TrainingView<Real>& view,
                               const AdamStep<Real>& adam, std::span<const uint32_t> cellOfRank) {
  foam_ = foam;
  rows_ = rows;
  view_ = &view;
  adam_ = &adam;
  count_ = static_cast<uint32_t>(cellOfRank.size());
  growTo(cells_, count_);
  growTo(details_, size_t{count_} * foam.shape.detailCount);
  rankOf_.assign(foam.shape.cellCount, SeenCells<Real>::kNotSeen);
  planeCount_ = 0;
  for (uint32_t rank = 0; rank < count_; ++rank) {
    const uint32_t cell = cellOfRank[rank];
    rankOf_[cell] = rank;
    cells_[rank].cell = cell;
    cells_[rank].radius = 0;
    cells_[rank].planesBegin = planeCount_;
    planeCount_ += rows.offsets[cell + 1] - rows.offsets[cell];
    cells_[rank].planesEnd = planeCount_;
  }
  growTo(planes_, planeCount_);
  states_.assign(count_, kNone);
  growTo(guardedBalls_, count_);
  tbb::parallel_for(0u, count_, [&](uint32_t rank) {
    const glm::vec<4, Real> ball = foam.balls[cellOfRank[rank]];
    const glm::vec<3, Real> centre = glm::vec<3, Real>(ball) - view.eye;
    const Real radius = foam::guardedRadius(centre, ball.w);
    guardedBalls_[rank] = {centre, radius * radius};
  });
}

template <class Real>
void PreparedCells<Real>::prepare(uint32_t rank) {
  std::atomic_ref<uint8_t> state(states_[rank]);
  uint8_t found = state.load(std::memory_order_acquire);
  if (found == kDone) return;
  if (found == kNone && state.compare_exchange_strong(found, kBegun, std::memory_order_acquire)) {
    fill(rank);
    state.store(kDone, std::memory_order_release);
    state.notify_all();
    return;
  }
  while (found != kDone) {
    state.wait(found, std::memory_order_acquire);
    found = state.load(std::memory_order_acquire);
  }
}

template <class Real>
void PreparedCells<Real>::fill(uint32_t rank) {
  SeenCell<Real>& prepared = cells_[rank];
  const uint32_t cell = prepared.cell, detailCount = foam_.shape.detailCount;
  const TrainedCell<Real> trained(foam_, *adam_, cell);
  prepareCell(trained, view_->eye, prepared);
  for (uint32_t e = rows_.offsets[cell]; e < rows_.offsets[cell + 1]; ++e) {
    planes_[prepared.planesBegin + e - rows_.offsets[cell]] = preparePlane(foam_, *view_, cell, rows_.neighbours[e]);
  }
  for (uint32_t k = 0; k < detailCount; ++k) {
    details_[size_t{rank} * detailCount + k] = prepareDetail(trained, prepared, k);
  }
}

template class PreparedCells<float>;
template class PreparedCells<double>;

}  // namespace froth
