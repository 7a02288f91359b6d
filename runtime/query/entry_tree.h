// Where to begin the search for the power cell of a point: a cell whose site is probably near.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

// A cell by chunk and index in the chunk.
struct CellAddress {
  uint32_t chunk = 0, cell = 0;
  bool operator==(const CellAddress&) const = default;
};

// A balanced kd-tree over a sample of the sites, searched to one leaf without backtracking.
class EntryTree {
 public:
  struct Sample {
    glm::vec3 site;
    CellAddress cell;
  };

  EntryTree() = default;
  // Keeps the greatest power of two of the samples. At least one.
  explicit EntryTree(std::vector<Sample> samples);

  CellAddress find(const glm::vec3& point) const;
  uint64_t bytes() const { return splits_.size() * sizeof(Split) + leaves_.size() * sizeof(CellAddress); }

 private:
  struct Split {
    float place = 0;
    uint32_t axis = 0;
  };

  void build(size_t node, std::span<Sample> samples);

  std::vector<Split> splits_;        // [leaves] a heap: the children of node k are 2k and 2k + 1; 0 is unused
  std::vector<CellAddress> leaves_;  // [power of two]
};

}  // namespace froth
