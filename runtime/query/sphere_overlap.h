// Where a sphere touches the solid part of a foam.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "froth/froth_query.h"
#include "runtime/query/convex_body.h"
#include "runtime/query/query_foam.h"

namespace froth {

// The point of the solid nearest to a sphere's centre, in the asset's frame.
struct SolidContact {
  double distance;  // from the centre; inside: minus the way out through the cell's face
  glm::dvec3 position, normal;
  CellAddress cell;
};

class SphereOverlap {
 public:
  // opticalDepth: least one, across its whole ball, of a cell that counts as solid (froth.h, FrothSphere::opacity).
  // `memory` outlives it.
  SphereOverlap(const QueryFoam& foam, const glm::dvec3& centre, double opticalDepth, std::pmr::memory_resource* memory)
      : foam_(foam),
        centre_(centre),
        opticalDepth_(opticalDepth),
        candidates_(memory),
        known_(memory),
        halfSpaces_(memory) {}

  // The nearest contact that is at most `reach` away.
  std::optional<SolidContact> findNearest(double reach);

 private:
  struct Candidate {
    double distance;  // lower bound, of the power cell from the centre
    CellAddress cell;
  };
  // Cells that were candidates already.
  class CellSet {
   public:
    explicit CellSet(std::pmr::memory_resource* memory) : places_(memory) {}
    bool insert(CellAddress cell);  // false: it was there

   private:
    std::pmr::vector<uint64_t> places_;  // open addressing; 0: free
    size_t count_ = 0;
  };

  void visit(CellAddress cell);
  void push(double distance, CellAddress cell);
  bool isSolid(const QueryChunk& chunk, uint32_t cell) const;
  void meetBody(CellAddress cell, const QueryChunk& chunk, const glm::dvec3& local);

  const QueryFoam& foam_;
  glm::dvec3 centre_;
  double opticalDepth_;
  double reach_ = 0;
  std::optional<SolidContact> nearest_;
  std::pmr::vector<Candidate> candidates_;  // a heap, nearest first
  CellSet known_;
  std::pmr::vector<HalfSpace> halfSpaces_;  // of the visited cell, in its frame [radii]
};

}  // namespace froth
