// The alpha-complex: pairs of the regular triangulation whose face polygon meets the ball.
//
// On a radical plane both powers are equal, so the face lies in the ball of i exactly where it lies in the
// ball of j: a pair is decided once, from its side with fewer neighbours. The polygons thus cost the sum of
// min(degree) over the pairs times a row, and one cell with 100,000 neighbours is no trouble.
//
// Every step errs to the superset: each half-space is widened by a slack that covers the rounding. That alone would
// let an empty cell keep the one neighbour that its ball all but misses and lose the one that cuts the ball off. So a
// cell is nothing unless some face comes into its ball with the half-spaces narrowed, too.
#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "baker/graph/graph.h"
#include "baker/graph/half_space.h"

namespace froth {
namespace {

constexpr uint32_t kProgressSlabs = 64;

struct Scratch {
  std::vector<HalfSpace> halfSpaces;  // that cut the ball
  std::vector<uint32_t> entries;      // their places in the neighbour array
  std::vector<glm::dvec2> polygon, clipped;
};

// Smallest distance of the origin from the polygon's boundary, squared.
double squaredDistanceToBoundary(std::span<const glm::dvec2> polygon) {
  double smallest = INFINITY;
  glm::dvec2 from = polygon.back();
  for (const glm::dvec2& to : polygon) {
    const glm::dvec2 edge = to - from;
    const double squaredLength = glm::dot(edge, edge);
    const double t = squaredLength > 0 ? std::clamp(-glm::dot(from, edge) / squaredLength, 0.0, 1.0) : 0.0;
    const glm::dvec2 nearest = from + t * edge;
    smallest = std::min(smallest, glm::dot(nearest, nearest));
    from = to;
  }
  return smallest;
}

// Whether the part of plane `face` inside all other half-spaces comes into the unit ball. side: 1: widened by their
// slack; -1: narrowed.
// The plane cuts the ball in a disc; a square around the disc is clipped, and what is left must come into the
// disc: around its centre, or with its boundary.
bool faceMeetsBall(const HalfSpace& face, double side, Scratch& scratch) {
  const double height = std::abs(face.offset), reachOfBall = 1 + side * face.slack;
  if (height > reachOfBall) return false;
  const double discRadius = std::sqrt((reachOfBall - height) * (reachOfBall + height));
  const auto [u, v] = planeAxes(face.normal);

  std::vector<glm::dvec2>& polygon = scratch.polygon;
  polygon = {
      {-discRadius, -discRadius}, {discRadius, -discRadius}, {discRadius, discRadius}, {-discRadius, discRadius}};
  bool holdsCentre = true;
  for (const HalfSpace& other : scratch.halfSpaces) {
    if (&other == &face) continue;
    const glm::dvec2 across(glm::dot(other.normal, u), glm::dot(other.normal, v));
    const double limit =
        other.offset - face.offset * glm::dot(other.normal, face.normal) + side * (other.slack + face.slack);
    const double reach = glm::length(across) * discRadius;
    holdsCentre = holdsCentre && limit >= 0;
    if (limit >= reach) continue;
    if (limit < -reach) return false;
    clipPolygon(polygon, across, limit, scratch.clipped);
    if (polygon.empty()) return false;
  }
  return holdsCentre || squaredDistanceToBoundary(polygon) <= discRadius * discRadius * (1 + side * kPolygonSlack);
}

// What is known of a pair: no face in the ball; one by the widened half-spaces; one by the narrowed, too.
enum class Face : uint8_t { kNone, kPossible, kSure };

class AlphaComplexBuilder {
 public:
  AlphaComplexBuilder(std::span<const glm::vec3> sites, std::span<const float> radii, const CellGraph& graph,
                      uint32_t completeCells)
      : sites_(sites),
        radii_(radii),
        graph_(graph),
        completeCells_(completeCells),
        faces_(graph.neighbours.size(), Face::kNone) {}

  // Decides every pair that the cell owns.
  void decideOwnedPairs(uint32_t cell, Scratch& scratch) {
    scratch.halfSpaces.clear();
    scratch.entries.clear();
    for (uint32_t entry = graph_.offsets[cell]; entry < graph_.offsets[cell + 1]; ++entry) {
      const HalfSpace halfSpace = makeHalfSpace(sites_, radii_, cell, graph_.neighbours[entry]);
      if (halfSpace.offset > 1 + halfSpace.slack) continue;  // holds the whole ball
      scratch.halfSpaces.push_back(halfSpace);
      scratch.entries.push_back(entry);
    }
    for (size_t k = 0; k < scratch.entries.size(); ++k) {
      const uint32_t entry = scratch.entries[k];
      if (!owns(cell, graph_.neighbours[entry]) || !faceMeetsBall(scratch.halfSpaces[k], 1, scratch)) continue;
      faces_[entry] = faceMeetsBall(scratch.halfSpaces[k], -1, scratch) ? Face::kSure : Face::kPossible;
    }
  }

  // Takes over what the owners decided. Owned entries are only read here, the others only written.
  void copyDecisions(uint32_t cell) {
    for (uint32_t entry = graph_.offsets[cell]; entry < graph_.offsets[cell + 1]; ++entry) {
      const uint32_t owner = graph_.neighbours[entry];
      if (owns(cell, owner)) continue;
      const auto row = graph_.neighbours.begin() + graph_.offsets[owner];
      const auto rowEnd = graph_.neighbours.begin() + graph_.offsets[owner + 1];
      faces_[entry] = faces_[std::lower_bound(row, rowEnd, cell) - graph_.neighbours.begin()];
    }
  }

  // Without a sure face in its ball, a cell is the whole ball, with all offsets >= 1, or nothing, with its site
  // beyond some plane, offset < 0. Any threshold between tells them apart, whatever the rounding.
  bool isEmpty(uint32_t cell) const {
    if (cell >= completeCells_) return false;
    bool isCutOff = false;
    for (uint32_t entry = graph_.offsets[cell]; entry < graph_.offsets[cell + 1]; ++entry) {
      if (faces_[entry] == Face::kSure) return false;
      isCutOff = isCutOff || makeHalfSpace(sites_, radii_, cell, graph_.neighbours[entry]).offset < 0.5;
    }
    return isCutOff;
  }

  // Pairs of empty cells are none: their faces are within the slack of nothing.
  CellGraph takeKept(const std::vector<uint8_t>& isEmpty) {
    for (size_t cell = 0; cell + 1 < graph_.offsets.size(); ++cell) {
      for (uint32_t entry = graph_.offsets[cell]; entry < graph_.offsets[cell + 1]; ++entry) {
        if (isEmpty[cell] || isEmpty[graph_.neighbours[entry]]) faces_[entry] = Face::kNone;
      }
    }
    CellGraph kept;
    kept.offsets.reserve(graph_.offsets.size());
    kept.neighbours.reserve(faces_.size() - std::count(faces_.begin(), faces_.end(), Face::kNone));
    kept.offsets.push_back(0);
    for (size_t cell = 0; cell + 1 < graph_.offsets.size(); ++cell) {
      for (uint32_t entry = graph_.offsets[cell]; entry < graph_.offsets[cell + 1]; ++entry) {
        if (faces_[entry] != Face::kNone) kept.neighbours.push_back(graph_.neighbours[entry]);
      }
      kept.offsets.push_back(static_cast<uint32_t>(kept.neighbours.size()));
    }
    return kept;
  }

 private:
  uint32_t degree(uint32_t cell) const { return graph_.offsets[cell + 1] - graph_.offsets[cell]; }
  bool owns(uint32_t cell, uint32_t neighbour) const {
    if (cell >= completeCells_) return false;
    const uint32_t own = degree(cell), other = degree(neighbour);
    if (neighbour >= completeCells_) return true;
    return own < other || (own == other && cell < neighbour);
  }

  std::span<const glm::vec3> sites_;
  std::span<const float> radii_;
  const CellGraph& graph_;
  const uint32_t completeCells_;
  std::vector<Face> faces_;  // per entry of graph_.neighbours
};

}  // namespace

AlphaComplex computeAlphaComplex(std::span<const glm::vec3> sites, std::span<const float> radii,
                                 const RegularTriangulation& triangulation, const Progress& progress,
                                 uint32_t completeCells) {
  using Range = tbb::blocked_range<uint32_t>;
  const uint32_t cellCount = static_cast<uint32_t>(sites.size());
  AlphaComplexBuilder builder(sites, radii, triangulation.graph, completeCells);

  const uint32_t slab = cellCount / kProgressSlabs + 1;
  for (uint32_t first = 0; first < cellCount; first += slab) {
    if (!report(progress, "alpha-complex", first, cellCount)) return {};
    tbb::parallel_for(Range(first, std::min(first + slab, cellCount)), [&](const Range& range) {
      Scratch scratch;
      for (uint32_t cell = range.begin(); cell < range.end(); ++cell) builder.decideOwnedPairs(cell, scratch);
    });
  }
  tbb::parallel_for(Range(0, cellCount), [&](const Range& range) {
    for (uint32_t cell = range.begin(); cell < range.end(); ++cell) builder.copyDecisions(cell);
  });
  if (!report(progress, "alpha-complex", cellCount, cellCount)) return {};

  AlphaComplex result;
  result.isEmpty.resize(cellCount);
  tbb::parallel_for(Range(0, cellCount), [&](const Range& range) {
    for (uint32_t cell = range.begin(); cell < range.end(); ++cell) result.isEmpty[cell] = builder.isEmpty(cell);
  });
  if (!report(progress, "alpha-complex", cellCount, cellCount)) return {};
  result.graph = builder.takeKept(result.isEmpty);
  return result;
}

}  // namespace froth
