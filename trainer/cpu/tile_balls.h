// The balls of a tile's list, in blocks: most of them a ray misses, and that is found for a block at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

template <class Real>
class TileBalls {
 public:
  static constexpr uint32_t kBlock = 16;

  // guardedBalls: PreparedCells::guardedBalls(). ranks: the list.
  void take(std::span<const glm::vec<4, Real>> guardedBalls, std::span<const uint32_t> ranks) {
    blocks_.resize((ranks.size() + kBlock - 1) / kBlock);
    for (size_t place = 0; place < blocks_.size() * kBlock; ++place) {
      Block& block = blocks_[place / kBlock];
      const size_t i = place % kBlock;
      const glm::vec<4, Real> ball = place < ranks.size() ? guardedBalls[ranks[place]] : kNoBall;
      block.x[i] = ball.x;
      block.y[i] = ball.y;
      block.z[i] = ball.z;
      block.squaredRadius[i] = ball.w;
    }
  }

  size_t blockCount() const { return blocks_.size(); }

  // Bit i: the line of the ray may meet the ball at place block * kBlock + i. Loops without branches, for the compiler
  // to take several balls at once.
  uint32_t mayMeet(size_t index, const glm::vec<3, Real>& direction) const {
    const Block& block = blocks_[index];
    Real excess[kBlock];
    for (uint32_t i = 0; i < kBlock; ++i) {
      const Real along = block.x[i] * direction.x + block.y[i] * direction.y + block.z[i] * direction.z;
      const Real x = block.x[i] - along * direction.x;
      const Real y = block.y[i] - along * direction.y;
      const Real z = block.z[i] - along * direction.z;
      excess[i] = x * x + y * y + z * z - block.squaredRadius[i];
    }
    uint32_t bits = 0;
    for (uint32_t i = 0; i < kBlock; ++i) bits |= static_cast<uint32_t>(!(excess[i] >= 0)) << i;
    return bits;
  }

 private:
  struct Block {
    Real x[kBlock], y[kBlock], z[kBlock];  // centres, relative to the eye
    Real squaredRadius[kBlock];            // with a guard for rounding
  };
  static constexpr glm::vec<4, Real> kNoBall{0, 0, 0, -1};
  std::vector<Block> blocks_;
};

}  // namespace froth
