// Samples of a power diagram: what a walk over its graphs finds, against searches that know no graph.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "baker/graph/graph.h"
#include "foam/site_tree.h"

namespace froth {

// Refers to the arrays it was made from; at least one cell is visible. Checks may run at the same time, each
// a function of (seed, number) alone; they append what they find wrong.
class DiagramCheck {
 public:
  DiagramCheck(std::span<const glm::vec3> sites, std::span<const float> radii,
               const RegularTriangulation& triangulation, const AlphaComplex& alpha, uint64_t seed);

  // A walk down the power ends in the cell of least power.
  void checkPoint(uint32_t number, std::vector<std::string>& faults) const;

  // Each cell on a ray's walk has the least power from entry to exit: the power of a cell less the least
  // power is convex along a line, so it is enough to look at both ends. Then each ball on the ray: its
  // bounded cell is the same from alpha planes and from all planes, and where the ray is in the middle of it,
  // the walk is in the cell of least power. Cells are told apart by powers: which of the cells of a cluster a
  // ray from far away meets, and for how long, is lost in the rounding of t.
  void checkRay(uint32_t number, std::vector<std::string>& faults) const;

 private:
  struct Ray {
    glm::dvec3 origin, direction;  // unit direction
  };
  struct Interval {
    double near = 0, far = 0;  // from the place next to the ball's centre
    double length() const { return far > near ? far - near : 0; }
  };

  struct Step {
    uint32_t cell;
    double exit;  // t; infinite for the last
  };

  uint32_t visibleFrom(uint64_t cell) const;
  glm::dvec3 pointInBall(uint64_t sample, uint32_t cell) const;
  glm::dvec3 pointInScene(uint64_t sample) const;
  glm::dvec3 pointByFace(uint64_t sample, const glm::dvec3& start) const;
  uint32_t descend(const glm::dvec3& x, uint32_t start) const;
  template <class Takes>  // bool(uint32_t neighbour)
  uint32_t descendAmong(const glm::dvec3& x, uint32_t start, const Takes& takes) const;
  uint32_t nextOnRay(const Ray& ray, uint32_t cell, double& t) const;
  void checkLeast(const glm::dvec3& x, double t, uint32_t cell, const char* what,
                  std::vector<std::string>& faults) const;
  std::vector<Step> walk(const Ray& ray, uint32_t cell, std::vector<std::string>& faults) const;
  static uint32_t cellAt(const std::vector<Step>& steps, double t);
  std::vector<uint32_t> findBallsOn(const Ray& ray) const;
  Interval boundedCell(const Ray& ray, uint32_t cell, std::span<const uint32_t> neighbours) const;

  std::span<const glm::vec3> sites_;
  std::span<const float> radii_;
  const RegularTriangulation& triangulation_;
  const AlphaComplex& alpha_;
  uint64_t seed_;
  SiteTree tree_;
  glm::dvec3 low_, high_;  // the sites' box
};

// The second half of checkGraphs: adds samples of the diagram to `validity`, also of graphs that it would refuse, whose
// alpha rows are not symmetric. At least one cell is not hidden; rows hold cells. False: `progress` asked to stop.
bool sampleDiagram(std::span<const glm::vec3> sites, std::span<const float> radii,
                   const RegularTriangulation& triangulation, const AlphaComplex& alpha, uint64_t seed,
                   const Progress& progress, ValidityReport& validity);

}  // namespace froth
