// The regular triangulation: CGAL's, with exact predicates.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include "baker/graph/graph.h"

namespace froth {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<uint32_t, Kernel,
                                                CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
// A site once hidden stays hidden while sites are only added, so CGAL need not keep it.
using CellBase = CGAL::Regular_triangulation_cell_base_3<Kernel, CGAL::Triangulation_cell_base_3<Kernel>,
                                                         CGAL::Discard_hidden_points>;
using Triangulation =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

constexpr uint64_t kProgressSteps = 200;

Status checkFinite(std::span<const glm::vec3> sites, std::span<const float> radii) {
  for (size_t i = 0; i < sites.size(); ++i) {
    const glm::vec3& p = sites[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return makeError(ErrorKind::kBadInput, "cell %zu: site (%g, %g, %g) is not finite; repair the foam", i,
                       double{p.x}, double{p.y}, double{p.z});
    }
    if (!std::isfinite(radii[i]) || !(radii[i] > 0)) {
      return makeError(ErrorKind::kBadInput, "cell %zu: radius %g is not a positive number; repair the foam",
                       i, double{radii[i]});
    }
  }
  return {};
}

// One index per distinct position: of coinciding sites the one with the largest radius, then the lowest
// index.
std::vector<uint32_t> findDistinctSites(std::span<const glm::vec3> sites, std::span<const float> radii) {
  std::vector<uint32_t> order(sites.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const glm::vec3 &p = sites[a], &q = sites[b];
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    if (p.z != q.z) return p.z < q.z;
    if (radii[a] != radii[b]) return radii[a] > radii[b];
    return a < b;
  });
  const auto coincide = [&](uint32_t a, uint32_t b) { return sites[a] == sites[b]; };
  order.erase(std::unique(order.begin(), order.end(), coincide), order.end());
  return order;
}

// CGAL's biased random insertion order, which keeps both the walks to a site and the expected updates short.
void sortForInsertion(std::vector<uint32_t>& order, std::span<const glm::vec3> sites) {
  const auto position = [sites](uint32_t i) { return Kernel::Point_3(sites[i].x, sites[i].y, sites[i].z); };
  const auto map = boost::make_function_property_map<uint32_t, Kernel::Point_3>(position);
  CGAL::spatial_sort(order.begin(), order.end(),
                     CGAL::Spatial_sort_traits_adapter_3<Kernel, decltype(map)>(map));
}

// Inserts one by one, each search starting where the last one ended. False: cancelled.
bool insertSites(Triangulation& triangulation, std::span<const uint32_t> order,
                 std::span<const glm::vec3> sites, std::span<const float> radii, const Progress& progress) {
  const uint64_t interval = order.size() / kProgressSteps + 1;
  Triangulation::Cell_handle hint;
  for (size_t k = 0; k < order.size(); ++k) {
    if (k % interval == 0 && !report(progress, "triangulate", k, order.size())) return false;
    const glm::vec3& p = sites[order[k]];
    const double radius = radii[order[k]];  // its square is exact in double
    const Kernel::Weighted_point_3 point({p.x, p.y, p.z}, radius * radius);
    Triangulation::Locate_type type;
    int i, j;
    const Triangulation::Cell_handle cell = triangulation.locate(point, type, i, j, hint);
    const Triangulation::Vertex_handle vertex = triangulation.insert(point, type, cell, i, j);
    const bool isVisible = vertex != Triangulation::Vertex_handle();
    if (isVisible) vertex->info() = order[k];
    hint = isVisible ? vertex->cell() : cell;
  }
  return report(progress, "triangulate", order.size(), order.size());
}

// Edges of any dimension's triangulation, as sorted rows.
CellGraph collectRows(const Triangulation& triangulation, size_t cellCount) {
  CellGraph graph;
  graph.offsets.assign(cellCount + 1, 0);
  if (triangulation.dimension() < 1) return graph;
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  for (auto edge = triangulation.finite_edges_begin(); edge != triangulation.finite_edges_end(); ++edge) {
    pairs.emplace_back(edge->first->vertex(edge->second)->info(), edge->first->vertex(edge->third)->info());
    ++graph.offsets[pairs.back().first + 1];
    ++graph.offsets[pairs.back().second + 1];
  }
  std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
  graph.neighbours.resize(2 * pairs.size());
  std::vector<uint32_t> cursors(graph.offsets.begin(), graph.offsets.end() - 1);
  for (const auto& [a, b] : pairs) {
    graph.neighbours[cursors[a]++] = b;
    graph.neighbours[cursors[b]++] = a;
  }
  for (size_t i = 0; i < cellCount; ++i) {
    std::sort(graph.neighbours.begin() + graph.offsets[i], graph.neighbours.begin() + graph.offsets[i + 1]);
  }
  return graph;
}

}  // namespace

Result<RegularTriangulation> triangulateRegular(std::span<const glm::vec3> sites,
                                                std::span<const float> radii, const Progress& progress) {
  if (Status status = checkFinite(sites, radii); !status) return status.error();

  RegularTriangulation result;
  std::vector<uint32_t> order = findDistinctSites(sites, radii);
  result.duplicates = sites.size() - order.size();
  sortForInsertion(order, sites);

  Triangulation triangulation;
  if (!insertSites(triangulation, order, sites, radii, progress)) {
    return makeError(ErrorKind::kCancelled, "triangulation stopped on request");
  }
  result.isHidden.assign(sites.size(), 1);
  for (auto vertex : triangulation.finite_vertex_handles()) result.isHidden[vertex->info()] = 0;
  result.graph = collectRows(triangulation, sites.size());
  return result;
}

}  // namespace froth
