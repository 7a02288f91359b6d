// What a .froth asset holds, decoded: the struct that the baker hands to the writer and that the reader gives back.
// docs/FORMAT.md says how it lies in the file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "format/quantization.h"

namespace froth {

// ChunkContents::solidBalls: largest byte; the cell's own ball.
inline constexpr uint32_t kMaxSolidByte = 64;
inline constexpr uint32_t kWholeBall = 0x40202020;

// A reference to a cell anywhere in the asset: (chunk << localBits) | local index. localBits belongs to the asset.
using CellRef = uint32_t;

// One chunk, complete in itself: it can be drawn and walked without any other chunk.
// Cells [0, liveCount) are live (they can contribute to an image); cells [liveCount, cellCount) only cut their
// neighbours and guide walks (dead: no density; empty: their ball lies wholly in other power cells; Steiner: made by
// the baker). Behind them, ghosts: copies of the sites and radii of cells of other chunks that are neighbours of cells
// of this one. Positions are relative to `origin`.
struct ChunkContents {
  std::array<double, 3> origin{};  // [scene units] added to every site of the chunk
  uint32_t cellCount = 0;
  uint32_t liveCount = 0;  // <= cellCount
  uint32_t ghostCount = 0;

  std::vector<glm::vec3> sites;    // [cellCount + ghostCount] [scene units]
  std::vector<float> radii;        // [cellCount + ghostCount] [scene units, > 0]
  std::vector<CellRef> ghostRefs;  // [ghostCount] where each ghost lives, ascending; with levels its border number

  // With levels: the cells that other chunks know as ghosts, and which border each is (docs/STREAMING.md). Chunks of
  // several levels may hold the same border: one of them is drawn.
  std::vector<uint32_t> borderCells;    // [borders] local, ascending
  std::vector<uint32_t> borderNumbers;  // [borders] < AssetContents::borderCount

  // Graph, compressed rows. Row i is neighbours[neighbourOffsets[i] .. neighbourOffsets[i + 1]), indices into sites.
  // A live cell's row starts with its alphaCounts[i] true alpha-complex neighbours, nearest radical plane first
  // (ascending radicalOffset / |toNeighbour|); then come its other neighbours in the regular triangulation, in the same
  // order. Without a walk graph only the alpha part is there.
  std::vector<uint32_t> neighbourOffsets;  // [cellCount + 1]
  std::vector<uint32_t> neighbours;        // [neighbourOffsets.back()] < cellCount + ghostCount
  std::vector<uint32_t> alphaCounts;       // [liveCount]

  std::vector<float> densities;         // [liveCount] [1 / scene unit]
  std::vector<glm::vec4> orientations;  // [liveCount] unit quaternion (w, x, y, z), rows n, t, b

  // A ball around the solid part of each cell: all points where a ray can gain opacity there, with a margin
  // (shaders/foam/ solid_ball.h). Bytes x, y, z, radius, each <= kMaxSolidByte, from the lowest; empty: kWholeBall
  // each.
  std::vector<uint32_t> solidBalls;  // [liveCount]

  // Layer 0: one colour and one displacement per cell, for readers that stop there. Empty in a foam that has no layers.
  std::vector<glm::vec3> cellColours;  // [liveCount] display-coded, n / 255 with n in 0..255
  std::vector<float> cellHeights;      // [liveCount] in units of the radius; empty: all zero

  // Layer 1.
  std::vector<glm::vec2> detailSites;  // [liveCount * K] in units of the radius
  std::vector<float> detailHeights;    // [liveCount * K] in units of the radius; empty: all zero
  std::vector<glm::vec3> baseColours;  // [liveCount * K] offset from one half; empty: all zero
  // [liveCount] lattices of the cell's detail sites and heights: steps * 2^scale [0..15]; empty: all 0
  std::vector<uint8_t> detailScales;
  std::vector<uint8_t> colourScales;  // [liveCount] colour lattice of the cell: step * 2^scale [0..15]; empty: all 0

  // Layer 2. The lobes of a detail site follow each other; sum(lobeCounts) in all. A detail site's colour along a unit
  // direction is max(0, 1/2 + base + sum w c / sum w) over its lobes; without lobes the last term is 0.
  std::vector<uint8_t> lobeCounts;     // [liveCount * K] 0..M; empty: M each
  std::vector<glm::vec3> lobeAxes;     // [lobes]
  std::vector<glm::vec3> lobeColours;  // [lobes]
};

// An axis-aligned box; all zero: nothing in it.
struct Box {
  std::array<double, 3> min{}, max{};  // [scene units]
};

// A pinhole camera of a path or a start view; axes x right, y down, z forward.
struct StoredCamera {
  std::array<double, 12> worldFromCamera{};  // 3 rows of 4
  double tanHalfFovY = 0.5;                  // half-height of the image plane at depth 1
};

// The eyes that a bake had in mind: all points within `radius` of one of the boxes; a box may be a single point. The
// figures are of views from such eyes that the bake was not given.
struct EyeRegion {
  std::vector<Box> boxes;              // empty: unknown
  double radius = 0;                   // [scene units]
  double worstPsnr = 0, meanPsnr = 0;  // against the input, dB; 0: not measured
};

// What happened in the bake; shown by `froth info`.
struct BakeStatistics {
  uint64_t inputCells = 0;        // cells in the input
  uint64_t hiddenDropped = 0;     // sites with an empty power cell: not in the asset
  uint64_t duplicatesMerged = 0;  // of these, sites that coincide with another one
  uint64_t emptyCells = 0;        // power cell, but no bounded cell
  uint64_t deadCells = 0;         // density too low to be seen
  uint64_t unseenCulled = 0;      // dropped because no camera sees more of them than the stated contribution
  uint64_t steinerCells = 0;      // added to fill empty space
  uint64_t walkPairs = 0;         // undirected pairs of the regular triangulation
  uint64_t alphaPairs = 0;        // undirected pairs of the alpha-complex
};

// Measured error of one attribute over the live cells: what is stored against the input.
struct AttributeError {
  std::string name;  // "sites", "radii", ...
  std::string unit;  // "scene units", "relative", "radians", "radius", "display-coded"
  double rms = 0, max = 0;
};

// The first layers of an asset are a complete, coarser scene: K = 1 and no lobes; K detail sites and no lobes; all.
enum class Layer : uint8_t { kGeometry = 0, kDetails = 1, kViewDependence = 2 };

inline constexpr uint32_t kNoGroup = 0xffffffff;

// Levels of detail (docs/STREAMING.md). A group is cells of one level that become coarser together: the chunks that
// are `in` it are drawn, or those `madeBy` it.
struct LevelGroup {
  // A ball around the balls of its live cells, of both forms, and around the balls of the groups that lie finer below.
  std::array<double, 3> centre{};  // [scene units]
  double radius = 0;               // [scene units]
  // Size of a pixel from which on the coarse form stands for the fine one [scene units]; less than that of each group
  // that its coarse chunks are in.
  double error = 0;
  uint32_t level = 0;  // of the fine form
};

// Where a chunk stands in the levels.
struct ChunkLevel {
  uint32_t level = 0;          // 0: the finest
  uint32_t madeBy = kNoGroup;  // kNoGroup: level 0
  uint32_t in = kNoGroup;      // kNoGroup: nothing is coarser; the chunk belongs to the floor
};

struct AssetContents {
  uint32_t detailCount = 0;  // K [1..32]
  uint32_t lobeCount = 0;    // M, most lobes of a detail site [0..32]; 0: no view dependence
  uint32_t localBits = 32;   // split of a CellRef; 32: one chunk, the reference is the local index
  bool hasWalkGraph = true;

  float detailSharpness = 10.0f;  // tau of the soft Voronoi weights exp(-tau |x - s|^2 / r^2)
  float nearRatio = 4.0f;         // default near tests of primary visibility (docs/FOAM.md "Near cells")
  float nearDepth = 0.0f;         // [scene units]
  std::string preset = "exact";
  std::string source;  // name of the input file, without folder
  BakeStatistics statistics;

  Quantization quantization;
  std::vector<glm::vec3> axisCodebook;  // lobe axes to choose from; empty: axes are stored one by one
  std::vector<AttributeError> errors;   // informative
  double psnr = 0;                      // against the input on sample views, dB; 0: not measured
  EyeRegion eyes;                       // informative

  StoredCamera startView;  // valid if hasStartView
  bool hasStartView = false;
  std::vector<StoredCamera> flightPath;  // may be empty

  std::vector<ChunkContents> chunks;  // >= 1

  // Levels of detail; all empty: the chunks are the scene.
  std::vector<ChunkLevel> levels;  // [chunks] the floor first, level 0 last
  std::vector<LevelGroup> groups;
  uint32_t borderCount = 0;  // cells that chunks share, over all levels
};

}  // namespace froth
