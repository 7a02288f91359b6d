// The levels of an asset as a graph of groups (docs/STREAMING.md): which chunks are the fine and the coarse form of
// each group, which groups lie coarser and finer, and what refining costs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/asset_contents.h"
#include "format/group_bounds.h"

namespace froth {

// Of one asset, as the reader has checked them.
struct LevelTables {
  std::span<const ChunkLevel> levels;  // [chunks]; empty: all chunks are the floor
  std::span<const LevelGroup> groups;
  std::span<const uint64_t> bytes;  // [chunks] of memory while it is resident
  std::span<const uint32_t> cells;  // [chunks] live
  std::span<const Box> liveBoxes;   // [chunks] in the axes of the asset, as placeBox() makes them; empty without levels
};

// Never changes. Thread safety: any number of readers.
class LevelGraph {
 public:
  struct Chunk {
    uint32_t madeBy = kNoGroup, in = kNoGroup;  // ChunkLevel
    uint64_t bytes = 0;
    uint32_t cells = 0;
  };
  // Prices are what the cut grows by when the group is refined. The coarse chunks need not stay, but for those of the
  // floor. A price is never negative, so each cut inside an affordable one is affordable too.
  struct Group {
    GroupBounds bounds;
    double error = 0;  // LevelGroup
    uint64_t bytePrice = 0, cellPrice = 0;
  };

  LevelGraph() = default;
  explicit LevelGraph(const LevelTables& tables);

  uint32_t chunkCount() const { return static_cast<uint32_t>(chunks_.size()); }
  uint32_t groupCount() const { return static_cast<uint32_t>(groups_.size()); }
  const Chunk& chunk(uint32_t index) const { return chunks_[index]; }
  const Group& group(uint32_t index) const { return groups_[index]; }

  std::span<const uint32_t> fineOf(uint32_t group) const { return fine_.row(group); }      // chunks in it
  std::span<const uint32_t> coarseOf(uint32_t group) const { return coarse_.row(group); }  // chunks that it made
  std::span<const uint32_t> coarserThan(uint32_t group) const {
    return coarser_.row(group);
  }                                                                                        // its coarse chunks' groups
  std::span<const uint32_t> finerThan(uint32_t group) const { return finer_.row(group); }  // what made its fine chunks

  std::span<const uint32_t> floor() const { return floor_; }    // chunks
  std::span<const uint32_t> lowest() const { return lowest_; }  // groups that no group is coarser than
  uint64_t floorBytes() const { return floorBytes_; }
  uint64_t floorCells() const { return floorCells_; }
  uint64_t finestBytes() const { return finestBytes_; }  // of level 0
  uint64_t finestCells() const { return finestCells_; }
  uint64_t allBytes() const { return allBytes_; }  // of all levels
  // Most bytes that a group holds besides its price while both of its forms are resident.
  uint64_t mostCoarseBytes() const { return mostCoarseBytes_; }

 private:
  struct Rows {
    std::vector<uint32_t> offsets{0}, items;
    std::span<const uint32_t> row(uint32_t index) const {
      return {items.data() + offsets[index], items.data() + offsets[index + 1]};
    }
  };
  // Chunks by the group that `field` names, ascending.
  Rows chunksBy(uint32_t Chunk::*field) const;
  // For each group the groups that `field` of its row of chunks names, each once, ascending.
  Rows groupsOf(const Rows& chunks, uint32_t Chunk::*field) const;
  void setPrices();

  std::vector<Chunk> chunks_;
  std::vector<Group> groups_;
  Rows fine_, coarse_, coarser_, finer_;
  std::vector<uint32_t> floor_, lowest_;
  uint64_t floorBytes_ = 0, floorCells_ = 0, finestBytes_ = 0, finestCells_ = 0, allBytes_ = 0, mostCoarseBytes_ = 0;
};

}  // namespace froth
