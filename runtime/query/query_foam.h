// An asset as queries see it: what decides where rays are stopped and which cell holds a point, in host memory. No
// colours.
//
// Sites keep the floats of the reader, relative to their chunk; all that is computed with them is double. Thread
// safety: built by one thread, then read by any number.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/result.h"
#include "format/asset_contents.h"
#include "runtime/query/chunk_geometry.h"
#include "runtime/query/entry_tree.h"
#include "runtime/query/packed_elements.h"

namespace froth {

// A detail site's place on the face and its height [radii].
struct QueryDetail {
  glm::vec2 place;
  float height;
};

// ChunkContents has the meaning of what has the same name.
struct QueryChunk {
  glm::dvec3 origin{0};
  uint32_t cellCount = 0, liveCount = 0;
  std::vector<glm::vec4> siteRadius;       // [cells, then ghosts]
  std::vector<uint32_t> neighbourOffsets;  // [cellCount + 1]
  // rows ascending: sites lie along a curve, so that a row reads memory forwards
  PackedElements neighbours;
  std::vector<CellRef> ghostRefs;
  std::vector<float> densities;         // [liveCount]
  std::vector<glm::vec4> orientations;  // [liveCount]
  std::vector<QueryDetail> details;     // [liveCount * K]; empty: the chunk has no heights

  glm::dvec3 siteOf(uint32_t site) const { return glm::dvec3(siteRadius[site]); }
  double radiusOf(uint32_t site) const { return siteRadius[site].w; }
  double densityOf(uint32_t cell) const { return cell < liveCount ? densities[cell] : 0.0f; }
  uint32_t neighbourAt(uint32_t index) const {
    const uint32_t bits = 32u >> neighbours.shift;
    const uint32_t place = index & ((1u << neighbours.shift) - 1);
    return neighbours.words[index >> neighbours.shift] >> (place * bits) & (0xffffffffu >> (32 - bits));
  }
  // Columns n (face normal), t, b.
  glm::dmat3 faceFrameOf(uint32_t cell) const {
    const glm::dvec4 q(orientations[cell]);
    return glm::transpose(glm::mat3_cast(glm::dquat(q.x, q.y, q.z, q.w)));
  }
};

// The neighbours' rows in the order of sites.
QueryChunk makeQueryChunk(const ChunkContents& contents);

class QueryFoam {
 public:
  // Without a walk graph nothing is kept: no query can be answered.
  explicit QueryFoam(const AssetContents& manifest);

  void addChunk(QueryChunk&& made, const LiveBounds& bounds);  // in the asset's order
  // After the last one: that each ghost is where its cell is, and as large. The name is for messages.
  Status checkGhosts(const std::string& name) const;
  void finish();  // after the last one: now it is whole
  bool isWhole() const { return isWhole_; }

  bool hasWalkGraph() const { return hasWalkGraph_; }
  uint32_t detailCount() const { return detailCount_; }
  double detailSharpness() const { return detailSharpness_; }
  bool hasCells() const { return entries_.bytes() > 0; }
  bool hasLiveCells() const { return bounds_.low.x <= bounds_.high.x; }
  uint64_t bytes() const { return bytes_; }

  const QueryChunk& chunk(uint32_t index) const { return chunks_[index]; }
  // Of the detail sites of a live cell [radii].
  double meanHeightOf(const QueryChunk& chunk, uint32_t cell) const;
  // The cell that a site of a chunk is, or for which it stands as a ghost.
  CellAddress cellOfSite(uint32_t chunk, uint32_t site) const;

  // The power cell that holds a point of the asset. There must be cells and a walk graph.
  CellAddress locate(const glm::dvec3& point) const;
  double powerOf(CellAddress cell, const glm::dvec3& point) const;

  // Box of the balls of live cells.
  const glm::dvec3& low() const { return bounds_.low; }
  const glm::dvec3& high() const { return bounds_.high; }

 private:
  bool hasWalkGraph_, isWhole_ = false;
  uint32_t detailCount_, localBits_;
  double detailSharpness_;
  std::vector<QueryChunk> chunks_;
  std::vector<EntryTree::Sample> samples_;  // until finish()
  EntryTree entries_;
  LiveBounds bounds_;
  uint64_t bytes_ = 0;
};

}  // namespace froth
