// How the graph of a chunk lies in the file: each pair once; and how rows come from it.
//
// Pairs {i, j} of indices into the chunk's sites are kept at the smaller index i, which is an own cell's: j
// is a larger own cell or a ghost. Packing and unpacking stand in the writing and the reading library.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/limits.h"

namespace froth {

// Three sections' raw bytes. Without a walk graph only the pairs of the alpha-complex are there, and no bits.
// A cell's pairs stand at ascending places of a list that begins with likely neighbours
// (format/pair_order.h).
struct PackedGraph {
  std::vector<uint8_t> counts;     // [cellCount] elements: pairs kept at each cell
  std::vector<uint8_t> deltas;     // [pairs] elements: a cell's first place, then place - (place before) - 1
  std::vector<uint8_t> alphaBits;  // [(pairs + 7) / 8] bit p % 8 of byte p / 8: whether pair p is in the
                                   // alpha-complex against expectation (or is not, against it)
};

// Degrees of a chunk's sites as pairs are added one by one, against the limits of format/limits.h.
class DegreeCheck {
 public:
  explicit DegreeCheck(uint64_t siteCount) : degrees_(siteCount) {}
  // `place` names the chunk in messages.
  Status add(uint32_t site, uint32_t neighbour, const std::string& place);

 private:
  std::vector<uint32_t> degrees_;
  uint64_t squares_ = 0;
};

// Size of an element of counts and deltas [bytes]: 2 up to 32768 sites, 4 beyond.
uint32_t graphElementSize(const ChunkContents& chunk);

// Reads the counts, sites, radii, neighbourOffsets, neighbours and alphaCounts. Rows may be in any order.
// Fails if they are not symmetric: j in the row of an own i if and only if i in that of an own j, and both or
// none as alpha (a live cell's mark counts if the other is not live), or if a site has too many neighbours.
Result<PackedGraph> packGraph(const ChunkContents& chunk, bool hasWalkGraph);

// The inverse: fills neighbourOffsets, neighbours and alphaCounts from the packed graph, the counts, sites
// and radii of `chunk`, which must be there (sites and radii of any value). Everything in the spans is
// checked before use; allocates 28 bytes per pair, 20 per site, and 24 per neighbour of the longest row.
// `place` names the chunk in messages.
struct PackedGraphView {
  std::span<const uint8_t> counts, deltas, alphaBits;
};
Status unpackGraph(const PackedGraphView& packed, bool hasWalkGraph, ChunkContents& chunk, const std::string& place);

// From the site of a cell to the radical plane towards another site, negative beyond the site [scene units].
// In double; 0 if there is no such plane.
double planeDistance(const ChunkContents& chunk, uint32_t cell, uint32_t neighbour);

// Sorts both parts of the rows of cells [first, last) into the order that ChunkContents promises; alpha
// neighbours must be in front already. Baker and reader share it, so that a baked chunk and a read one agree.
// Safe to call for disjoint ranges from several threads. Indices must be valid.
void sortGraphRows(ChunkContents& chunk, uint32_t first, uint32_t last);

}  // namespace froth
