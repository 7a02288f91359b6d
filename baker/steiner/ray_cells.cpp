#include "baker/steiner/ray_cells.h"

#include <algorithm>
#include <cmath>

#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr double kOpaque = 6.9;      // optical depth at which a walk ends
constexpr double kSolidShare = 0.5;  // of a ball lies behind its face
constexpr int kWindows = 32;         // of the scene's extent: a ray is followed window by window until it ends

double crossing(const BallLine& a, const BallLine& b) { return (b.offset - a.offset) / (2 * (b.slope - a.slope)); }

// Finds the cells of one ray from nearest balls of points alone: between two cells, either their lines'
// crossing lies on the envelope, or the cell there parts the search.
class EnvelopeSearch {
 public:
  struct Found {
    uint32_t cell;
    BallLine line;
    double begin;
  };

  EnvelopeSearch(const SiteTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                 const WalkRay& ray)
      : tree_(tree), sites_(sites), radii_(radii), ray_(ray) {}

  // The cell at a place of the ray, which `known` holds unless another one does.
  Found cellAt(double t, const Found& known) const {
    const glm::dvec3 point = glm::dvec3(ray_.origin) + t * glm::dvec3(ray_.direction);
    return found(tree_.findLeastPower(point, known.cell).site, t);
  }
  Found firstCell() const { return found(tree_.findLeastPower(ray_.origin).site, 0); }

  void findBetween(const Found& first, const Found& last, std::vector<Found>& found) const {
    if (!(first.line.slope < last.line.slope)) return;
    const double t = std::clamp(crossing(first.line, last.line), first.begin, last.begin);
    const Found middle = cellAt(t, first);
    const bool parts = middle.line.slope > first.line.slope && middle.line.slope < last.line.slope;
    if (parts && middle.line.at(t) < first.line.at(t)) {
      findBetween(first, middle, found);
      findBetween(middle, last, found);
    } else {
      found.push_back({last.cell, last.line, t});
    }
  }

 private:
  Found found(uint32_t cell, double t) const { return {cell, lineOf(sites_[cell], radii_[cell], ray_), t}; }

  const SiteTree& tree_;
  std::span<const glm::vec3> sites_;
  std::span<const float> radii_;
  const WalkRay& ray_;
};

double opticalDepth(const glm::vec3& site, float radius, float density, const WalkRay& ray, double begin, double end) {
  const glm::dvec3 centre = glm::dvec3(site) - glm::dvec3(ray.origin);
  double tNear, tFar;
  if (foam::isNearCell(centre, double{radius}, glm::dvec3(ray.forward), double{ray.nearRatio}, double{ray.nearDepth})) {
    return 0;
  }
  if (!foam::intersectBall(centre, double{radius}, glm::dvec3(ray.direction), tNear, tFar)) return 0;
  return kSolidShare * density * std::max(0.0, std::min(tFar, end) - std::max(tNear, begin));
}

}  // namespace

BallLine lineOf(const glm::vec3& site, float radius, const WalkRay& ray) {
  const glm::dvec3 centre = glm::dvec3(site) - glm::dvec3(ray.origin);
  return {glm::dot(centre, glm::dvec3(ray.direction)), foam::powerOfOrigin(centre, double{radius})};
}

RayCells::RayCells(const SiteTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                   std::span<const float> densities, const WalkRay& ray) {
  const EnvelopeSearch search(tree, sites, radii, ray);
  const glm::dvec3 low = tree.bounds().ballLow, high = tree.bounds().ballHigh;
  const double extent = glm::length(high - low);
  const double limit = extent + glm::length(glm::dvec3(ray.origin) - 0.5 * (low + high));
  std::vector<EnvelopeSearch::Found> found{search.firstCell()};
  double depth = 0;
  size_t passed = 0;  // pieces whose end is known and whose density is counted
  for (int window = 1; end_ < limit && depth < kOpaque; ++window) {
    end_ = std::min(limit, window * limit / kWindows);
    const EnvelopeSearch::Found last = found.back();
    search.findBetween(last, search.cellAt(end_, last), found);
    for (; passed + 1 < found.size() && depth < kOpaque; ++passed) {
      const uint32_t cell = found[passed].cell;
      depth +=
          opticalDepth(sites[cell], radii[cell], densities[cell], ray, found[passed].begin, found[passed + 1].begin);
    }
  }
  if (depth >= kOpaque) {
    end_ = found[passed].begin;
    found.resize(passed);
  }
  for (const EnvelopeSearch::Found& one : found) pieces_.push_back({one.line, one.begin});
}

RayCells::Cut RayCells::cutOf(const BallLine& ball) const {
  const int count = static_cast<int>(pieces_.size());
  const auto isBelow = [&](int i, double t) { return ball.at(t) < pieces_[i].line.at(t); };
  // Envelope minus line is concave: it is largest where the slopes change from smaller to larger ones.
  const int after =
      static_cast<int>(std::lower_bound(pieces_.begin(), pieces_.end(), ball.slope,
                                        [](const Piece& piece, double slope) { return piece.line.slope < slope; }) -
                       pieces_.begin());
  Cut cut{after - 1, after, 0, end_};
  if (!isBelow(std::min(after, count - 1), after < count ? pieces_[after].begin : end_)) return cut;
  cut.isEmpty = false;
  while (cut.left >= 0 && isBelow(cut.left, pieces_[cut.left].begin)) --cut.left;
  while (cut.right < count && isBelow(cut.right, endOf(cut.right))) ++cut.right;
  if (cut.left >= 0) cut.begin = crossing(pieces_[cut.left].line, ball);
  if (cut.right < count) cut.end = crossing(pieces_[cut.right].line, ball);
  return cut;
}

std::vector<RayCells::Interval> RayCells::emptyIntervals() const {
  std::vector<Interval> intervals;
  const auto add = [&](double begin, double end) {
    if (begin < end) intervals.push_back({begin, end});
  };
  for (int i = 0; i < static_cast<int>(pieces_.size()); ++i) {
    const BallLine& line = pieces_[i].line;
    const double begin = pieces_[i].begin, end = endOf(i);
    const double halfChordSquared = line.slope * line.slope - line.offset;
    if (halfChordSquared <= 0) {
      add(begin, end);
    } else {
      const double halfChord = std::sqrt(halfChordSquared);
      add(begin, std::min(end, line.slope - halfChord));
      add(std::max(begin, line.slope + halfChord), end);
    }
  }
  return intervals;
}

int RayCells::savingOf(const BallLine& ball) const {
  const Cut cut = cutOf(ball);
  return cut.isEmpty ? 0 : cut.right - cut.left - 2;
}

void RayCells::add(const BallLine& ball) {
  const Cut cut = cutOf(ball);
  if (cut.isEmpty) return;
  std::vector<Piece> changed(pieces_.begin(), pieces_.begin() + (cut.left + 1));
  changed.push_back({ball, cut.begin});
  if (cut.right < static_cast<int>(pieces_.size())) {
    changed.insert(changed.end(), pieces_.begin() + cut.right, pieces_.end());
    changed[cut.left + 2].begin = cut.end;
  }
  pieces_.swap(changed);
}

}  // namespace froth
