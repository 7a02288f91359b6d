#include "baker/graph/local_triangulation.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "base/counter_random.h"

namespace froth {

namespace {

constexpr uint64_t kProgressSteps = 200;
constexpr std::chrono::milliseconds kLongestSilence{200};
constexpr uint32_t kRowsPerLook = 1024;
constexpr size_t kBatch = 512;  // insertions between two looks at the progress: a few milliseconds

// A biased random insertion order (Amenta, Choi, Rote, "Incremental constructions con BRIO", 2003): an eighth of the
// sites first, of these an eighth before them, and so on, each round along the curve.
constexpr int kRounds = 8;

int roundOf(uint32_t place) {
  const uint64_t random = mixBits(place);
  return std::min(std::countr_zero(random) / 3, kRounds - 1);
}

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

bool LocalTriangulation::insert(std::span<const uint32_t> places, InsertionProgress& progress, bool isCounted) {
  size_t inserted = 0, counted = 0;
  for (int round = kRounds - 1; round >= 0; --round) {
    for (const uint32_t place : places) {
      if (roundOf(place) != round) continue;
      insertPlace(place);
      if (++inserted % kBatch != 0) continue;
      if (!progress.add(isCounted ? kBatch : 0)) return false;
      counted = inserted;
    }
  }
  return progress.add(isCounted ? inserted - counted : 0);
}

void LocalTriangulation::insertPlace(uint32_t place) {
  const glm::vec3& p = sites_.sites[sites_.order[place]];
  const double radius = sites_.radii[sites_.order[place]];  // its square is exact in double
  const Kernel::Weighted_point_3 point(Kernel::Point_3(p.x, p.y, p.z), radius * radius);
  Triangulation::Locate_type type;
  int i, j;
  // Each search starts where the last one ended.
  const Triangulation::Cell_handle cell = triangulation_.locate(point, type, i, j, hint_);
  const Triangulation::Vertex_handle vertex = triangulation_.insert(point, type, cell, i, j);
  const bool isVisible = vertex != Triangulation::Vertex_handle();
  if (isVisible) vertex->info() = place;
  hint_ = isVisible ? vertex->cell() : cell;
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
    if (triangulation_.dimension() >= 1) triangulation_.finite_adjacent_vertices(vertex, std::back_inserter(adjacent));
    block.cells.push_back(sites_.order[vertex->info()]);
    block.degrees.push_back(static_cast<uint32_t>(adjacent.size()));
    for (const Triangulation::Vertex_handle other : adjacent) block.neighbours.push_back(sites_.order[other->info()]);
  }
  return block;
}

}  // namespace froth
