// Graphs of a power diagram: regular triangulation, alpha-complex (docs/FOAM.md "Graphs").
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/progress.h"
#include "base/result.h"
#include "foam/cell_graph.h"

namespace froth {

struct RegularTriangulation {
  CellGraph graph;                // pairs whose power cells share a face; rows of hidden cells are empty
  std::vector<uint8_t> isHidden;  // [cells] 1: the power cell is empty (covered by others, or a duplicate)
  uint64_t duplicates = 0;        // of coinciding sites the largest radius, then the lowest index, stays
};

// CGAL, sequential, exact predicates on exactly these floats. Any input of finite numbers works: fewer than
// five sites, collinear, coplanar, cospherical, duplicate ones (lower-dimensional triangulations give the
// right graph too).
Result<RegularTriangulation> triangulateRegular(std::span<const glm::vec3> sites, std::span<const float> radii,
                                                const Progress& progress = {});

struct AlphaComplex {
  // Pairs whose bounded cells share a face: never a true pair missing, superfluous ones only within the
  // margin.
  CellGraph graph;
  std::vector<uint8_t> isEmpty;  // [cells] 1: not hidden, but the bounded cell is empty
};

// One polygon per pair, clipped in double; all cores, the same result on any number of them. When `progress`
// asks to stop the result is empty (no offsets): whoever stopped it drops it.
// Of a part of a scene only cells [0, completeCells) have all their neighbours: pairs of the others are left out, and
// none of them is empty.
AlphaComplex computeAlphaComplex(std::span<const glm::vec3> sites, std::span<const float> radii,
                                 const RegularTriangulation& triangulation, const Progress& progress = {},
                                 uint32_t completeCells = UINT32_MAX);

// How a scene is cut into regions.
struct RegionPlan {
  uint32_t ownCells = 1 << 17;       // of a region, at most [>= 1]
  uint64_t localCells = UINT32_MAX;  // of a region and around it; one that needs more is halved
  int threads = 1024;                // regions triangulated at a time, if there are as many cores [>= 1]
};

// The same graph, region by region: each region is triangulated with as many sites around it as its stars
// need, proven by the empty orthospheres of their tetrahedra. Memory grows with the plan's cells, not with
// CGAL's share of the whole. Sites that have no regions (all in a plane, or fewer than one region's) are
// triangulated in one piece. kUnsupported: no region is small enough for plan.localCells.
Result<RegularTriangulation> triangulateRegions(std::span<const glm::vec3> sites, std::span<const float> radii,
                                                const RegionPlan& plan, const Progress& progress = {});

// In one piece if that fits `memoryLimit` [bytes; 0: none], the result included, else in regions that do.
// kUsage: the limit is too low for any.
Result<RegularTriangulation> triangulateWithin(uint64_t memoryLimit, std::span<const glm::vec3> sites,
                                               std::span<const float> radii, const Progress& progress = {});

// What was checked of the graphs of a bake, and what was found; `faults` is empty when all is well.
//
// Rows of both graphs are checked in full, the diagram by samples: at random points (in balls, in the scene's
// box, next to faces) a walk down the power over the graph must end in the cell of least power; on random
// rays every step of a walk must be in the cell of least power, every ball on the ray must be cut alike by
// alpha planes and by all planes, and none be left out. Least powers and balls on a ray are found without the
// graphs. All cores; the same for the same seed on any number of them. When `progress` asks to stop the report
// is unfinished: whoever stopped it drops it.
struct ValidityReport {
  uint64_t cells = 0, walkPairs = 0, alphaPairs = 0;
  uint64_t pointsChecked = 0, raysChecked = 0;  // against brute force
  std::vector<std::string> faults;              // at most 16, each with cell numbers and values
};
ValidityReport checkGraphs(std::span<const glm::vec3> sites, std::span<const float> radii,
                           const RegularTriangulation& triangulation, const AlphaComplex& alpha, uint64_t seed,
                           const Progress& progress = {});

}  // namespace froth
