// Some groups of an asset; docs/STREAMING.md calls them a cut if they hold all groups that are coarser than one of
// them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/stream/level_graph.h"

namespace froth {

// Members stay in the order in which they were added. Allocates in the constructor alone.
class GroupSet {
 public:
  GroupSet() = default;
  explicit GroupSet(uint32_t groupCount) : has_(groupCount) { members_.reserve(groupCount); }

  bool contains(uint32_t group) const { return has_[group] != 0; }
  std::span<const uint32_t> members() const { return members_; }
  void add(uint32_t group) {
    if (has_[group] != 0) return;
    has_[group] = 1;
    members_.push_back(group);
  }
  void clear() {
    for (const uint32_t group : members_) has_[group] = 0;
    members_.clear();
  }
  // members() still holds it until compact(). Returns whether it was in.
  bool drop(uint32_t group) {
    const bool was = has_[group] != 0;
    has_[group] = 0;
    return was;
  }
  void compact() {
    std::erase_if(members_, [&](uint32_t group) { return has_[group] == 0; });
  }

 private:
  std::vector<uint8_t> has_;  // [groups]
  std::vector<uint32_t> members_;
};

// Whether a cut draws a chunk.
inline bool isDrawnIn(const GroupSet& cut, const LevelGraph::Chunk& chunk) {
  return (chunk.in == kNoGroup || cut.contains(chunk.in)) && (chunk.madeBy == kNoGroup || !cut.contains(chunk.madeBy));
}

}  // namespace froth
