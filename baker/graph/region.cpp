#include "baker/graph/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace froth {
namespace {

constexpr uint32_t kCellsPerLook = 1024;  // at the progress

// Nearly all cells lie so deep in their region that no site outside comes near them, so they are proven by the
// group: one search for some tens of cells instead of one for each. Measured; a group that finds more candidates
// is halved, and cells of the smallest ones are searched for one by one.
constexpr size_t kGroup = 64, kSmallestGroup = 8, kMaxCandidates = 256;

}  // namespace

Region::Outcome Region::triangulate(std::span<const uint32_t> simplex, size_t maxCells, InsertionProgress& progress) {
  std::vector<uint32_t> places(end_ - begin_);
  std::iota(places.begin(), places.end(), begin_);
  std::fill(isLocal_.begin() + begin_, isLocal_.begin() + end_, true);
  if (!local_.insert(places, progress, false)) return Outcome::kStopped;

  places.assign(simplex.begin(), simplex.end());
  std::erase_if(places, [&](uint32_t place) { return isOwn(place); });
  for (const uint32_t place : places) isLocal_[place] = true;
  size_t localCount = end_ - begin_;
  do {
    localCount += places.size();
    if (localCount > maxCells) return Outcome::kTooLarge;
    if (!local_.insert(places, progress, false)) return Outcome::kStopped;
    places.clear();
    if (!findConflicts(places, progress)) return Outcome::kStopped;
  } while (!places.empty());
  return Outcome::kDone;
}

// Looks at all cells next to own sites that are not proven yet; appends a conflicting site for each that has
// one. False: stopped.
bool Region::findConflicts(std::vector<uint32_t>& places, InsertionProgress& progress) {
  uint32_t looked = 0;
  suspects_.clear();
  for (const CellHandle cell : local_.cgal().all_cell_handles()) {
    if (cell->info().isProven || !touchesOwn(cell)) continue;
    if (++looked % kCellsPerLook == 0 && !progress.add(0)) return false;
    std::optional<OuterSphere> sphere;
    if (!local_.cgal().is_infinite(cell)) sphere = orthosphereOf(cell).outerSphere();
    if (sphere) {
      suspects_.push_back({*sphere, cell});
    } else {
      decide(cell, findConflict(cell), places);
    }
  }
  return findConflictsOf(suspects_, places, progress);
}

// The same for some of the suspects, in groups of like place and size. False: stopped.
bool Region::findConflictsOf(std::span<Suspect> suspects, std::vector<uint32_t>& places, InsertionProgress& progress) {
  if (!progress.add(0)) return false;
  if (suspects.size() <= kGroup) {
    if (gatherCandidates(suspects)) {
      for (const Suspect& suspect : suspects) decide(suspect.cell, findAmongCandidates(suspect), places);
      return true;
    }
    if (suspects.size() <= kSmallestGroup) {
      for (const Suspect& suspect : suspects) decide(suspect.cell, findConflict(suspect.cell), places);
      return true;
    }
  }
  const auto key = [](const Suspect& suspect) {
    return glm::dvec4(suspect.sphere.centre, std::sqrt(std::max(suspect.sphere.squaredRadius, 0.0)));
  };
  glm::dvec4 low(INFINITY), high(-INFINITY);
  for (const Suspect& suspect : suspects) {
    low = glm::min(low, key(suspect));
    high = glm::max(high, key(suspect));
  }
  int axis = 0;
  for (int k = 1; k < 4; ++k) {
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  }
  const size_t half = suspects.size() / 2;
  std::nth_element(suspects.begin(), suspects.begin() + half, suspects.end(),
                   [&](const Suspect& a, const Suspect& b) { return key(a)[axis] < key(b)[axis]; });
  return findConflictsOf(suspects.first(half), places, progress) &&
         findConflictsOf(suspects.subspan(half), places, progress);
}

// All sites that are not in and may conflict with a cell of a group. False: too many.
bool Region::gatherCandidates(std::span<const Suspect> group) {
  double squaredRadius = -INFINITY;
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const Suspect& suspect : group) {
    low = glm::min(low, suspect.sphere.centre);
    high = glm::max(high, suspect.sphere.centre);
    squaredRadius = std::max(squaredRadius, suspect.sphere.squaredRadius);
  }
  // Above 0: no site in a box conflicts with a sphere of the group.
  const auto clearance = [&](const glm::dvec3& boxLow, const glm::dvec3& boxHigh, double radius) {
    const glm::dvec3 gap = glm::max(glm::max(boxLow - high, low - boxHigh), glm::dvec3(0));
    return glm::dot(gap, gap) * OuterSphere::kReach - squaredRadius - radius * radius;
  };
  candidates_.clear();
  double limit = 0;
  const auto bound = [&](const SiteTree::Node& node) {
    if (isOwn(node)) return double{INFINITY};
    return clearance(node.box.low, node.box.high, node.box.maxRadius);
  };
  tree_.search(limit, bound, [&](uint32_t place) {
    if (isLocal_[place]) return;
    const glm::dvec3 site(sites_.sites[sites_.order[place]]);
    const double radius = sites_.radii[sites_.order[place]];
    if (clearance(site, site, radius) > 0) return;
    candidates_.push_back({site, radius * radius, place});
    if (candidates_.size() > kMaxCandidates) limit = -INFINITY;
  });
  return candidates_.size() <= kMaxCandidates;
}

void Region::decide(CellHandle cell, std::optional<uint32_t> conflict, std::vector<uint32_t>& places) {
  cell->info().isProven = !conflict;
  if (!conflict || isLocal_[*conflict]) return;
  isLocal_[*conflict] = true;
  places.push_back(*conflict);
}

bool Region::touchesOwn(CellHandle cell) const {
  for (int k = 0; k < 4; ++k) {
    const VertexHandle vertex = cell->vertex(k);
    if (vertex != local_.cgal().infinite_vertex() && isOwn(vertex->info())) return true;
  }
  return false;
}

// The candidate deepest in conflict; it may have been added meanwhile.
std::optional<uint32_t> Region::findAmongCandidates(const Suspect& suspect) const {
  std::optional<PowerForm> sphere;
  std::optional<uint32_t> found;
  double limit = 0;
  for (const Candidate& candidate : candidates_) {
    const glm::dvec3 apart = candidate.site - suspect.sphere.centre;
    const double squaredReach = suspect.sphere.squaredRadius + candidate.squaredRadius;
    if (glm::dot(apart, apart) * OuterSphere::kReach > squaredReach) continue;
    if (!sphere) sphere = orthosphereOf(suspect.cell);
    const double lower = boundsAt(*sphere, candidate.place).lower;
    if (lower > limit) continue;
    limit = lower;
    found = candidate.place;
  }
  return found;
}

// A site that is not in yet and may conflict with a cell.
std::optional<uint32_t> Region::findConflict(CellHandle cell) const {
  int infinite;
  if (!cell->has_vertex(local_.cgal().infinite_vertex(), infinite)) return findInSphere(orthosphereOf(cell));
  // An infinite cell's sphere is the half-space beyond its facet; sites in the facet's plane conflict if they
  // do with the facet's own sphere.
  const bool isOdd = infinite % 2 == 1;
  const std::array<Ball, 3> facet = {ballAt(cell->vertex((infinite + (isOdd ? 1 : 2)) & 3)),
                                     ballAt(cell->vertex((infinite + (isOdd ? 2 : 1)) & 3)),
                                     ballAt(cell->vertex((infinite + 3) & 3))};
  return findBeyond(PowerForm::beyondTriangle(facet), PowerForm::ofTriangle(facet));
}

// The site deepest in conflict.
std::optional<uint32_t> Region::findInSphere(const PowerForm& sphere) const {
  std::optional<uint32_t> found;
  double limit = 0;
  const auto bound = [&](const SiteTree::Node& node) { return isOwn(node) ? INFINITY : sphere.lowerOver(node.box); };
  tree_.search(limit, bound, [&](uint32_t place) {
    if (isLocal_[place]) return;
    const double lower = boundsAt(sphere, place).lower;
    if (lower > limit) return;
    limit = lower;
    found = place;
  });
  return found;
}

// The site next to the facet of all that lie beyond it.
std::optional<uint32_t> Region::findBeyond(const PowerForm& beyond, const PowerForm& sphere) const {
  std::optional<uint32_t> found;
  double limit = std::numeric_limits<double>::max();
  const auto bound = [&](const SiteTree::Node& node) {
    const bool isOut = isOwn(node) || beyond.lowerOver(node.box) > 0;
    return isOut ? INFINITY : sphere.lowerOver(node.box);
  };
  tree_.search(limit, bound, [&](uint32_t place) {
    if (isLocal_[place]) return;
    const PowerForm::Bounds side = boundsAt(beyond, place);
    const double lower = boundsAt(sphere, place).lower;
    if (side.lower > 0 || (side.upper >= 0 && lower > 0) || lower > limit) return;
    limit = lower;
    found = place;
  });
  return found;
}

Ball Region::ballAt(VertexHandle vertex) const {
  const uint32_t cell = sites_.order[vertex->info()];
  return {glm::dvec3(sites_.sites[cell]), sites_.radii[cell]};
}

PowerForm Region::orthosphereOf(CellHandle cell) const {
  return PowerForm::ofTetrahedron(
      {ballAt(cell->vertex(0)), ballAt(cell->vertex(1)), ballAt(cell->vertex(2)), ballAt(cell->vertex(3))});
}

PowerForm::Bounds Region::boundsAt(const PowerForm& form, uint32_t place) const {
  return form.at(sites_.sites[sites_.order[place]], sites_.radii[sites_.order[place]]);
}

}  // namespace froth
