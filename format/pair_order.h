// Which sites are likely to be neighbours of a cell, given the pairs of the cells before it: what makes a
// packed graph small. Reader and writer share it. Internal to format/.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "format/asset_contents.h"

namespace froth {

// Walks through the cells of a chunk in order. Every cell has a list of the sites behind it: first the
// candidates, by ascending |d|^2 - r^2 (d the offset of the site, r its radius) and then index; then all
// sites behind the cell by index. (A candidate is listed twice; only its first place counts.) Candidates are
// the sites that a neighbour before the cell is paired with, unless that one keeps more than kMaxGuide pairs:
// that bounds the work at a hub.
class PairOrder {
 public:
  static constexpr uint32_t kMaxGuide = 32;

  // Reads sites and radii of the chunk, and its counts.
  explicit PairOrder(const ChunkContents& chunk);

  void startCell(uint32_t cell);  // 0, 1, 2 ...
  void add(uint32_t neighbour);   // a pair of this cell; neighbour > cell, a site of the chunk

  std::span<const uint32_t> candidates() const { return candidates_; }
  bool isCandidate(uint32_t site) const { return seenAt_[site] == cell_ + 1; }

  // Between a site that is no candidate and its place in the list. `siteAt` may be beyond the last site.
  uint64_t placeOf(uint32_t site) const { return candidates_.size() + (site - cell_ - 1); }
  uint64_t siteAt(uint64_t place) const {
    return place < candidates_.size() ? candidates_[place] : place - candidates_.size() + cell_ + 1;
  }

  // All pairs so far: those of cell i are [starts()[i], starts()[i + 1]).
  const std::vector<uint32_t>& starts() const { return starts_; }
  const std::vector<uint32_t>& neighbours() const { return neighbours_; }

 private:
  const ChunkContents& chunk_;
  uint32_t cell_ = 0;
  std::vector<uint32_t> starts_, neighbours_;
  std::vector<uint32_t> owners_;         // [pairs] the cell of each
  std::vector<uint32_t> sameNeighbour_;  // [pairs] the pair before with the same neighbour
  std::vector<uint32_t> lastPair_;       // [sites] the last pair with this neighbour
  std::vector<uint32_t> seenAt_;         // [sites] 1 + the last cell that had it as a candidate
  std::vector<std::pair<double, uint32_t>> ranking_;
  std::vector<uint32_t> candidates_;
};

// Whether the pair {cell, neighbour} is expected to be in the alpha-complex: the cell is live and the balls
// overlap.
bool isLikelyAlpha(const ChunkContents& chunk, uint32_t cell, uint32_t neighbour);

}  // namespace froth
