// Which cells a view sees, and in which tiles, on the CPU.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "trainer/step/training_view.h"

namespace froth {

// A cell that a view sees.
template <class Real>
struct Candidate {
  Real power = 0;  // of the eye
  uint32_t cell = 0;
  uint32_t tilesBegin = 0, tilesEnd = 0;  // CellCulling::tilesOf
};

template <class Real>
class CellCulling {
 public:
  using Balls = std::vector<glm::vec<4, Real>>;  // [cells] site, radius

  // After balls have moved, before the next cull().
  void follow(const Balls& balls);
  // Near tests, and the tiles that see each ball.
  void cull(const TrainingView<Real>& view, const Balls& balls);
  // Of the last cull(): front to back, equals by index.
  const std::vector<Candidate<Real>>& candidates() const { return candidates_; }
  std::span<const uint32_t> tilesOf(const Candidate<Real>& candidate) const;  // ascending

 private:
  // Cells that follow each other often lie beside each other, so they are culled together.
  static constexpr uint32_t kBlockCells = 256;
  struct Block {
    glm::vec<4, Real> ball;                   // around those of its cells
    std::vector<Candidate<Real>> candidates;  // by cell
    std::vector<uint32_t> tiles;              // of its candidates
  };
  void boundBlock(uint32_t block, const Balls& balls);
  void cullBlock(uint32_t block, const TrainingView<Real>& view, const Balls& balls, const Balls& cones);

  std::vector<Block> blocks_;
  std::vector<Candidate<Real>> candidates_;
};

}  // namespace froth
