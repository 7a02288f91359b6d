// The cells that a view can see, prepared for its rays. In a large foam most are hidden behind others, so a cell is
// prepared when the first ray comes to its ball, by that ray's thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trainer/step/seen_cells.h"
#include "trainer/step/trained_cell.h"
#include "trainer/step/training_view.h"

namespace froth {

template <class Real>
class PreparedCells {
 public:
  // Takes the cells that the view can see, by rank; none is prepared. The foam, its rows, the view and `adam` must stay
  // as they are while rays look.
  void take(const TrainedFoam<Real>& foam, const NeighbourRows& rows, const TrainingView<Real>& view,
            const AdamStep<Real>& adam, std::span<const uint32_t> cellOfRank);

  // On any thread; returns when the cell is prepared.
  void prepare(uint32_t rank);

  // Of a cell to which no ray came: its number, the places of its planes, and a radius of 0.
  SeenCells<Real> seen() { return {count_, cells_.data(), planes_.data(), details_.data(), rankOf_.data()}; }
  // By rank: centre, relative to the eye, and the square of the radius with a guard for rounding.
  std::span<const glm::vec<4, Real>> guardedBalls() const { return std::span(guardedBalls_).first(count_); }
  uint32_t count() const { return count_; }
  uint32_t planeCount() const { return planeCount_; }

 private:
  enum State : uint8_t { kNone, kBegun, kDone };
  void fill(uint32_t rank);

  TrainedFoam<Real> foam_;
  NeighbourRows rows_;
  const TrainingView<Real>* view_ = nullptr;
  const AdamStep<Real>* adam_ = nullptr;

  uint32_t count_ = 0, planeCount_ = 0;
  // At least so many: none of them ever shrinks.
  std::vector<SeenCell<Real>> cells_;
  std::vector<SeenPlane<Real>> planes_;
  std::vector<SeenDetail<Real>> details_;
  std::vector<glm::vec<4, Real>> guardedBalls_;
  std::vector<uint8_t> states_;
  std::vector<uint32_t> rankOf_;
};

}  // namespace froth
