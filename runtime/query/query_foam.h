// An asset as queries see it: what decides where rays are stopped and which cell holds a point, in host memory. No
// colours.
//
// Sites keep the floats of the reader, relative to their chunk; all that is computed with them is double. Thread
// safety: built by one thread, then read by any number. With levels of detail that one thread changes it between
// queries.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/result.h"
#include "format/asset_contents.h"
#include "runtime/query/ball_tree.h"
#include "runtime/query/chunk_geometry.h"
#include "runtime/query/entry_tree.h"
#include "runtime/query/packed_elements.h"

namespace froth {

// A detail site's place on the face and its height [radii].
struct QueryDetail {
  glm::vec2 place;
  float height;
};

// A cell that other chunks know as a ghost.
struct QueryBorder {
  uint32_t cell, number;
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
  std::vector<QueryBorder> borders;     // with levels
  std::vector<float> densities;         // [liveCount]
  std::vector<glm::vec4> orientations;  // [liveCount]
  std::vector<QueryDetail> details;     // [liveCount * K]; empty: the chunk has no heights
  BoxTree balls;                        // of live cells

  uint64_t arrayBytes() const;
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

// Chunks that answer together, and where searches among their cells begin.
struct QueryCut {
  std::vector<uint32_t> chunks;  // ascending
  EntryTree entries;
  glm::dvec3 origin{0};  // of the frame of `balls`
  BoxTree balls;         // items: places in `chunks`

  uint64_t treeBytes() const { return entries.bytes() + balls.bytes(); }
};

// Where a ray enters a ball: of a live cell, at t >= where the search began. Inside of a ball it enters there.
struct BallEntry {
  CellAddress cell;
  double t = std::numeric_limits<double>::infinity();  // none
  uint32_t asked = 0;                                  // boxes and balls
};

class QueryFoam {
 public:
  // Without a walk graph nothing is kept: no query can be answered. With levels, `bounds` holds the balls of the live
  // cells of all of them.
  explicit QueryFoam(const AssetContents& manifest, const LiveBounds& bounds = {});

  // ---- Without levels of detail

  void addChunk(QueryChunk&& made, const LiveBounds& bounds);  // in the asset's order
  // After the last one: that each ghost is where its cell is, and as large. The name is for messages.
  Status checkGhosts(const std::string& name) const;
  void finish();  // after the last one: now it is whole

  // ---- With levels (level_cut.cpp): a chunk has the number that it has in the file

  void setChunk(uint32_t number, QueryChunk&& made);
  void removeChunk(uint32_t number);                            // one that is not shown
  QueryCut makeCut(std::span<const uint32_t> ascending) const;  // of chunks that are there
  // From now on these chunks answer. The work grows with the borders of those that come and go.
  void show(QueryCut&& cut);

  // ----

  bool isWhole() const { return isWhole_; }  // it can be asked
  bool hasWalkGraph() const { return hasWalkGraph_; }
  uint32_t detailCount() const { return detailCount_; }
  double detailSharpness() const { return detailSharpness_; }
  bool hasCells() const { return cut_.entries.bytes() > 0; }
  bool hasLiveCells() const { return hasCells() && bounds_.low.x <= bounds_.high.x; }
  uint64_t bytes() const { return bytes_; }

  const QueryChunk& chunk(uint32_t index) const { return chunks_[index]; }
  // Of the detail sites of a live cell [radii].
  double meanHeightOf(const QueryChunk& chunk, uint32_t cell) const;
  // The cell that a site of the chunk of `from` is, or for which it stands as a ghost. `from` itself, if with levels
  // nothing that is shown has the ghost's cell: the file lies.
  CellAddress cellOfSite(CellAddress from, uint32_t site) const;

  // The power cell that holds a point of the asset. There must be cells and a walk graph.
  CellAddress locate(const glm::dvec3& point) const { return locateFrom(findEntry(point), point); }
  // Begins at a cell that is probably near.
  CellAddress locateFrom(CellAddress cell, const glm::dvec3& point) const;
  // The same while rows are short. false: it stands at a long one.
  bool approach(CellAddress& cell, const glm::dvec3& point) const;
  // In open space, where rows have hundreds of neighbours, a search in a tree is faster than one row.
  static bool isRowLong(const QueryChunk& chunk, uint32_t cell);
  CellAddress findEntry(const glm::dvec3& point) const { return cut_.entries.find(glm::vec3(point)); }
  // Where a ray from `origin` enters the first ball of a live cell from t = `from` on, before `to`.
  BallEntry findFirstBall(const glm::dvec3& origin, const glm::dvec3& direction, double from, double to) const;
  double powerOf(CellAddress cell, const glm::dvec3& point) const;

  // Box of the balls of live cells.
  const glm::dvec3& low() const { return bounds_.low; }
  const glm::dvec3& high() const { return bounds_.high; }

 private:
  static constexpr CellRef kNowhere = UINT32_MAX;

  QueryCut makeTrees(std::vector<uint32_t>&& chunks, std::vector<EntryTree::Sample>&& samples) const;
  void takeCut(QueryCut&& cut);
  bool descend(CellAddress& current, const glm::dvec3& point, uint32_t longestRow) const;
  void tellBorders(uint32_t chunk);
  void forgetBorders(uint32_t chunk);

  bool hasWalkGraph_, hasLevels_, isWhole_ = false;
  uint32_t detailCount_, localBits_;
  double detailSharpness_;
  std::vector<QueryChunk> chunks_;
  std::vector<EntryTree::Sample> samples_;  // until finish()
  QueryCut cut_;                            // that is shown; without levels all chunks
  std::vector<CellRef> borders_;            // [border number] the shown cell that it is, or kNowhere
  LiveBounds bounds_;
  uint64_t bytes_ = 0;
};

}  // namespace froth
