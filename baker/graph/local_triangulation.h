// CGAL's regular triangulation of some of the sites. Only files compiled with CGAL's flags include this.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <glm/glm.hpp>

#include "baker/graph/graph.h"

namespace froth {

// Sites that no other of them coincides with, in some order; a site is known by its place in it.
struct PlacedSites {
  std::span<const glm::vec3> sites;
  std::span<const float> radii;
  std::span<const uint32_t> order;  // site at each place
};

// Rows of some visible cells: unsorted, one after the other.
struct RowBlock {
  std::vector<uint32_t> cells, degrees, neighbours;
};

// Progress of insertions on several threads; `progress` is called by one at a time.
class InsertionProgress {
 public:
  InsertionProgress(const Progress& progress, const char* stage, uint64_t total)
      : progress_(progress), stage_(stage), total_(total) {}

  // Some more sites are in, out of the total; to be called every few milliseconds, if only with 0. False from
  // the moment that `progress` has asked to stop.
  bool add(uint64_t inserted);
  // Ends all insertions.
  void stop() { isStopped_ = true; }

 private:
  const Progress& progress_;
  const char* stage_;
  uint64_t total_;
  std::atomic<bool> isStopped_ = false;
  std::mutex mutex_;
  uint64_t done_ = 0, reported_ = 0;
  std::chrono::steady_clock::time_point reportedAt_{};
};

class LocalTriangulation {
 public:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  struct CellState {
    bool isProven = false;  // region.h
  };
  using VertexBase =
      CGAL::Triangulation_vertex_base_with_info_3<uint32_t, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
  // A site once hidden stays hidden while sites are only added, so CGAL need not keep it.
  using CellBase =
      CGAL::Regular_triangulation_cell_base_3<Kernel, CGAL::Triangulation_cell_base_with_info_3<CellState, Kernel>,
                                              CGAL::Discard_hidden_points>;
  using Triangulation =
      CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

  explicit LocalTriangulation(const PlacedSites& sites) : sites_(sites) {}

  // Inserts the sites at places that are not yet in, in a biased random order: fast if the places follow a curve
  // through space. Only what is counted counts as progress. False: stopped on request.
  bool insert(std::span<const uint32_t> places, InsertionProgress& progress, bool isCounted = true);

  // Rows of the visible cells at places [begin, end); none when stopped.
  RowBlock collectRows(uint32_t begin, uint32_t end, InsertionProgress& progress) const;

  const Triangulation& cgal() const { return triangulation_; }

 private:
  void insertPlace(uint32_t place);

  const PlacedSites& sites_;
  Triangulation triangulation_;  // infos are places
  Triangulation::Cell_handle hint_;
};

// Shared by the triangulation of the whole and of regions.
Status checkFinite(std::span<const glm::vec3> sites, std::span<const float> radii);
// All cells but for duplicates, along a Morton curve: of coinciding sites the one of largest radius, then lowest
// index stays. Fails with kCancelled.
Result<std::vector<uint32_t>> listDistinct(std::span<const glm::vec3> sites, std::span<const float> radii,
                                           const Progress& progress);
// The graph from the rows of all visible cells; takes the blocks apart.
RegularTriangulation assembleRows(const PlacedSites& sites, std::vector<RowBlock>&& blocks);

}  // namespace froth
