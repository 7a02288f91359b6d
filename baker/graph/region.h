// One region of a regular triangulation. Internal to region_triangulation.cpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "baker/graph/local_triangulation.h"
#include "baker/graph/orthosphere.h"
#include "foam/site_tree.h"

namespace froth {

// A region owns some sites. They are triangulated first alone, then with ever more sites around them. A cell of
// such a local triangulation is a cell of the whole one if no other site conflicts with it; CGAL breaks ties by
// a symbolic perturbation of weights that depends on the places of sites alone, so this holds for degenerate
// sites too. Each cell next to an own site is proven by a search over all sites for one that conflicts, or that
// may conflict as far as double can tell. If there is one it is added, and the cells that this makes are looked
// at again. In the end the stars of the own sites are those of the whole triangulation. Hidden sites need no
// proof: what some sites hide, more sites hide too.
class Region {
 public:
  // The region owns places of the tree; `sites` are placed in the tree's order.
  Region(const PlacedSites& sites, const SiteTree& tree, SiteTree::Range own)
      : sites_(sites), tree_(tree), begin_(own.begin), end_(own.end), isLocal_(sites.order.size()), local_(sites) {}

  enum class Outcome { kDone, kStopped, kTooLarge };
  // `simplex`: places of four sites that lie in no plane, so that the local triangulation has all dimensions.
  // Too large: more than `maxCells` sites would be in.
  Outcome triangulate(std::span<const uint32_t> simplex, size_t maxCells, InsertionProgress& progress);

  // Of the own sites; none when stopped.
  RowBlock collectRows(InsertionProgress& progress) const { return local_.collectRows(begin_, end_, progress); }

 private:
  using CellHandle = LocalTriangulation::Triangulation::Cell_handle;
  using VertexHandle = LocalTriangulation::Triangulation::Vertex_handle;

  // A cell next to own sites that is not proven yet.
  struct Suspect {
    OuterSphere sphere;
    CellHandle cell;
  };
  // A site that may conflict with some cell of a group.
  struct Candidate {
    glm::dvec3 site;
    double squaredRadius;
    uint32_t place;
  };

  bool isOwn(uint32_t place) const { return place >= begin_ && place < end_; }
  bool isOwn(const SiteTree::Node& node) const { return isOwn(node.begin) && isOwn(node.end - 1); }
  bool touchesOwn(CellHandle cell) const;

  bool findConflicts(std::vector<uint32_t>& places, InsertionProgress& progress);
  bool findConflictsOf(std::span<Suspect> suspects, std::vector<uint32_t>& places, InsertionProgress& progress);
  bool gatherCandidates(std::span<const Suspect> group);
  void decide(CellHandle cell, std::optional<uint32_t> conflict, std::vector<uint32_t>& places);

  std::optional<uint32_t> findAmongCandidates(const Suspect& suspect) const;
  std::optional<uint32_t> findConflict(CellHandle cell) const;
  std::optional<uint32_t> findInSphere(const PowerForm& sphere) const;
  std::optional<uint32_t> findBeyond(const PowerForm& beyond, const PowerForm& sphere) const;

  Ball ballAt(VertexHandle vertex) const;
  PowerForm orthosphereOf(CellHandle cell) const;
  PowerForm::Bounds boundsAt(const PowerForm& form, uint32_t place) const;

  const PlacedSites& sites_;
  const SiteTree& tree_;
  uint32_t begin_, end_;
  std::vector<bool> isLocal_;  // places that are in, or about to be
  LocalTriangulation local_;
  std::vector<Suspect> suspects_;
  std::vector<Candidate> candidates_;
};

}  // namespace froth
