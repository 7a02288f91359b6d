// Power diagrams by brute force, in double: what the graphs are tested against.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "foam/cell_graph.h"
#include "tests/graph/ball_sets.h"

namespace froth {

inline double powerAt(const BallSet& balls, uint32_t cell, const glm::dvec3& x) {
  const glm::dvec3 local = x - glm::dvec3(balls.sites[cell]);
  const double radius = balls.radii[cell];
  return glm::dot(local, local) - radius * radius;
}

inline uint32_t findPowerCell(const BallSet& balls, const glm::dvec3& x) {
  uint32_t best = 0;
  for (uint32_t i = 1; i < balls.size(); ++i) {
    if (powerAt(balls, i, x) < powerAt(balls, best, x)) best = i;
  }
  return best;
}

inline bool hasPair(const CellGraph& graph, uint32_t a, uint32_t b) {
  return std::binary_search(graph.neighbours.begin() + graph.offsets[a],
                            graph.neighbours.begin() + graph.offsets[a + 1], b);
}

// A point inside the face of two power cells, with clearance from every third cell.
struct FacePoint {
  uint32_t a, b;
  glm::dvec3 place;
  double power;  // < 0: inside both balls
};

// The faces that a straight line meets on its way through the whole diagram; those met too close to an edge
// are left out.
inline std::vector<FacePoint> findFacesAlong(const BallSet& balls, const glm::dvec3& origin,
                                             const glm::dvec3& direction, double clearance) {
  std::vector<FacePoint> faces;
  uint32_t cell = findPowerCell(balls, origin);
  for (uint32_t step = 0; step < balls.size(); ++step) {
    uint32_t next = cell;
    double nearest = std::numeric_limits<double>::infinity();
    for (uint32_t j = 0; j < balls.size(); ++j) {
      const double approach = 2 * glm::dot(direction, glm::dvec3(balls.sites[j]) - glm::dvec3(balls.sites[cell]));
      if (!(approach > 0)) continue;
      const double t = (powerAt(balls, j, origin) - powerAt(balls, cell, origin)) / approach;
      if (t < nearest) {
        nearest = t;
        next = j;
      }
    }
    if (next == cell) break;
    const glm::dvec3 place = origin + nearest * direction;
    const double power = powerAt(balls, cell, place);
    bool isClear = true;
    for (uint32_t k = 0; k < balls.size(); ++k) {
      isClear = isClear && (k == cell || k == next || powerAt(balls, k, place) - power > clearance);
    }
    if (isClear) faces.push_back({cell, next, place, power});
    cell = next;
  }
  return faces;
}

// Faces met by many lines: from inside one ball towards the inside of another, so that small cells are met
// too.
inline std::vector<FacePoint> sampleFaces(const BallSet& balls, uint32_t lines, uint64_t seed) {
  BallSetMaker random(seed);
  std::vector<FacePoint> faces;
  for (uint32_t line = 0; line < lines; ++line) {
    const uint32_t from = line % balls.size();
    const uint32_t to = static_cast<uint32_t>(random.uniform(0, 1) * balls.size());
    const glm::dvec3 origin = glm::dvec3(balls.sites[from]) + random.pointInCube(-1, 1) * double{balls.radii[from]};
    const glm::dvec3 target = glm::dvec3(balls.sites[to]) + random.pointInCube(-1, 1) * double{balls.radii[to]};
    const double length = glm::length(target - origin);
    if (!(length > 0)) continue;
    // Powers are of size 10^2 scene units^2: 1e-9 is some thousand roundings of them.
    const std::vector<FacePoint> met = findFacesAlong(balls, origin, (target - origin) / length, 1e-9);
    faces.insert(faces.end(), met.begin(), met.end());
  }
  return faces;
}

// Distances from one site, by enumeration of all candidates for the nearest point: the site, the foot of a
// plane, the foot of a line where two planes meet, a corner where three do. `slack` widens (> 0) or narrows
// (< 0) the power cell for the planes that a candidate does not lie on. Infinite: there is no such point.
// Costs n^4; for small sets.
class NearestPointOracle {
 public:
  NearestPointOracle(const BallSet& balls, uint32_t cell, double slack) : slack_(slack * balls.radii[cell]) {
    for (uint32_t j = 0; j < balls.size(); ++j) {
      const glm::dvec3 d = glm::dvec3(balls.sites[j]) - glm::dvec3(balls.sites[cell]);
      const double length = j == cell ? 1 : glm::length(d);
      const double r = balls.radii[cell], s = balls.radii[j];
      normals_.push_back(d / length);
      offsets_.push_back(j == cell ? INFINITY : 0.5 * (length + (r - s) * (r + s) / length));
    }
  }

  double distanceToCell() const {
    double nearest = isInside(glm::dvec3(0), {}) ? 0 : INFINITY;
    for (uint32_t j = 0; j < normals_.size(); ++j) nearest = std::min(nearest, distanceToFace(j));
    return nearest;
  }

  double distanceToFace(uint32_t j) const {
    if (offsets_[j] == INFINITY) return INFINITY;
    double nearest = INFINITY;
    consider(offsets_[j] * normals_[j], {j}, nearest);
    for (uint32_t k = 0; k < normals_.size(); ++k) {
      if (k == j || offsets_[k] == INFINITY) continue;
      const glm::dvec3 along = glm::cross(normals_[j], normals_[k]);
      const double squared = glm::dot(along, along);
      if (squared < 1e-20) continue;
      const glm::dvec3 foot = glm::cross(offsets_[j] * normals_[k] - offsets_[k] * normals_[j], along) / squared;
      consider(foot, {j, k}, nearest);
      for (uint32_t l = k + 1; l < normals_.size(); ++l) {
        const double slope = l == j || offsets_[l] == INFINITY ? 0 : glm::dot(normals_[l], along);
        if (std::abs(slope) < 1e-10) continue;
        consider(foot + along * ((offsets_[l] - glm::dot(normals_[l], foot)) / slope), {j, k, l}, nearest);
      }
    }
    return nearest;
  }

 private:
  void consider(const glm::dvec3& x, std::initializer_list<uint32_t> on, double& nearest) const {
    const double distance = glm::length(x);
    if (distance < nearest && isInside(x, on)) nearest = distance;
  }
  bool isInside(const glm::dvec3& x, std::initializer_list<uint32_t> on) const {
    for (uint32_t k = 0; k < normals_.size(); ++k) {
      if (std::find(on.begin(), on.end(), k) != on.end()) continue;
      if (glm::dot(normals_[k], x) > offsets_[k] + slack_) return false;
    }
    return true;
  }

  double slack_;
  std::vector<glm::dvec3> normals_;
  std::vector<double> offsets_;
};

}  // namespace froth
