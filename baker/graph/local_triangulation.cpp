#include "baker/graph/local_triangulation.h"

#include <algorithm>
#include <chrono>

#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

namespace froth {

namespace {

constexpr uint64_t kProgressSteps = 200;
constexpr std::chrono::milliseconds kLongestSilence{200};
constexpr uint32_t kRowsPerLook = 1024;
constexpr size_t kBatch = 512;  // insertions between two looks at the progress: a few milliseconds

}  // namespace

bool InsertionProgress::add(uint64_t inserted) {
  const std::lock_guard lock(mutex_);
  done_ += inserted;
  const auto now = std::chrono::steady_clock::now();
  if (done_ - reported_ > total_ / kProgressSteps || now - reportedAt_ > kLongestSilence) {
    reported_ = done_;
    reportedAt_ = now;
    if (!isStopped_ && !report(progress_, stage_, done_, total_)) isStopped_ = true;
  }
  return !isStopped_;
}

bool LocalTriangulation::insert(std::vector<uint32_t>& places, InsertionProgress& progress, bool isCounted) {
  const auto position = [this](uint32_t place) {
    const glm::vec3& p = sites_.sites[sites_.order[place]];
    return Kernel::Point_3(p.x, p.y, p.z);
  };
  const auto map = boost::make_function_property_map<uint32_t, Kernel::Point_3>(position);
  CGAL::spatial_sort(places.begin(), places.end(),
                     CGAL::Spatial_sort_traits_adapter_3<Kernel, decltype(map)>(map));

  for (size_t k = 0; k < places.size(); ++k) {
    if (k % kBatch == 0 && !progress.add(isCounted ? std::min(k, kBatch) : 0)) return false;
    const double radius = sites_.radii[sites_.order[places[k]]];  // its square is exact in double
    const Kernel::Weighted_point_3 point(position(places[k]), radius * radius);
    Triangulation::Locate_type type;
    int i, j;
    // Each search starts where the last one ended.
    const Triangulation::Cell_handle cell = triangulation_.locate(point, type, i, j, hint_);
    const Triangulation::Vertex_handle vertex = triangulation_.insert(point, type, cell, i, j);
    const bool isVisible = vertex != Triangulation::Vertex_handle();
    if (isVisible) vertex->info() = places[k];
    hint_ = isVisible ? vertex->cell() : cell;
  }
  return progress.add(places.empty() || !isCounted ? 0 : (places.size() - 1) % kBatch + 1);
}

RowBlock LocalTriangulation::collectRows(uint32_t begin, uint32_t end, InsertionProgress& progress) const {
  RowBlock block;
  block.cells.reserve(end - begin);
  block.degrees.reserve(end - begin);
  // Euler: a triangulation of the 3-sphere has as many edges as vertices and cells together.
  const size_t edges = triangulation_.number_of_vertices() + triangulation_.tds().number_of_cells();
  const double share = double(end - begin) / std::max<size_t>(triangulation_.number_of_vertices(), 1);
  block.neighbours.reserve(static_cast<size_t>(2.0 * edges * std::min(share, 1.0)));
  std::vector<Triangulation::Vertex_handle> adjacent;
  for (const Triangulation::Vertex_handle vertex : triangulation_.finite_vertex_handles()) {
    if (vertex->info() < begin || vertex->info() >= end) continue;
    if (block.cells.size() % kRowsPerLook == 0 && !progress.add(0)) return {};
    adjacent.clear();
    if (triangulation_.dimension() >= 1)
      triangulation_.finite_adjacent_vertices(vertex, std::back_inserter(adjacent));
    block.cells.push_back(sites_.order[vertex->info()]);
    block.degrees.push_back(static_cast<uint32_t>(adjacent.size()));
    for (const Triangulation::Vertex_handle other : adjacent)
      block.neighbours.push_back(sites_.order[other->info()]);
  }
  return block;
}

}  // namespace froth
