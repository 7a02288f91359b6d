// A graph of cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace froth {

// Symmetric graph in compressed rows; neighbours ascending within a row.
struct CellGraph {
  std::vector<uint32_t> offsets;     // [cells + 1]
  std::vector<uint32_t> neighbours;  // [offsets.back()]
};

inline std::span<const uint32_t> neighboursOf(const CellGraph& graph, uint32_t cell) {
  return std::span(graph.neighbours).subspan(graph.offsets[cell], graph.offsets[cell + 1] - graph.offsets[cell]);
}

}  // namespace froth
