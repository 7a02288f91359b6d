// Searches of a foam: the power cell of a point, and the ball that a ray enters first.
#include <algorithm>

#include "runtime/query/query_foam.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

// A search in a tree takes as long as a row of some hundred neighbours.
constexpr uint32_t kLongRow = 128;

double powerOf(const glm::vec4& siteRadius, const glm::dvec3& point) {
  const glm::dvec3 difference = point - glm::dvec3(siteRadius);
  return glm::dot(difference, difference) - double{siteRadius.w} * siteRadius.w;
}

// Item of a chunk's tree to cells: visit(cell) for those below `end`.
template <class Visit>
void forEachCell(uint32_t item, uint32_t end, const Visit& visit) {
  const uint32_t begin = item * kBallsPerBox;
  for (uint32_t cell = begin; cell < std::min(begin + kBallsPerBox, end); ++cell) visit(cell);
}

struct RaySearch {
  glm::dvec3 origin, direction;
  double from;
  BallEntry best;
  float limit;

  void take(CellAddress cell, double t) {
    best.cell = cell;
    best.t = t;
    limit = RayBounds::limitOf(t);
  }
};

struct RayInBoxes {
  RaySearch& search;
  RayBounds ray;

  RayInBoxes(RaySearch& asking, const glm::dvec3& frame, const BoxTree& tree)
      : search(asking), ray(asking.origin - frame, asking.direction, asking.from, tree.bounds()) {}
  void measure(const BoxTree::Node& node, float (&bounds)[BoxTree::kWidth]) const {
    search.best.asked += BoxTree::kWidth;
    ray.measure(node, bounds);
  }
  float limit() const { return search.limit; }
};

struct RayInChunk : RayInBoxes {
  const QueryChunk& chunk;
  uint32_t number;
  glm::dvec3 localOrigin;

  RayInChunk(RaySearch& asking, const QueryFoam& foam, uint32_t numberOfChunk)
      : RayInBoxes(asking, foam.chunk(numberOfChunk).origin, foam.chunk(numberOfChunk).balls),
        chunk(foam.chunk(numberOfChunk)),
        number(numberOfChunk),
        localOrigin(asking.origin - chunk.origin) {}

  void visit(uint32_t item) {
    search.best.asked += kBallsPerBox;
    forEachCell(item, chunk.liveCount, [&](uint32_t cell) {
      double tNear, tFar;
      const glm::dvec3 centre = chunk.siteOf(cell) - localOrigin;
      if (!foam::intersectBall(centre, chunk.radiusOf(cell), search.direction, tNear, tFar)) return;
      tNear = std::max(tNear, search.from);
      if (tNear < tFar && tNear < search.best.t) search.take({number, cell}, tNear);
    });
  }
};

struct RayInFoam : RayInBoxes {
  const QueryFoam& foam;
  const QueryCut& cut;

  RayInFoam(RaySearch& asking, const QueryFoam& inFoam, const QueryCut& inCut)
      : RayInBoxes(asking, inCut.origin, inCut.balls), foam(inFoam), cut(inCut) {}

  void visit(uint32_t item) {
    RayInChunk inChunk(search, foam, cut.chunks[item]);
    inChunk.chunk.balls.search(inChunk);
  }
};

}  // namespace

QueryCut QueryFoam::makeTrees(std::vector<uint32_t>&& chunks, std::vector<EntryTree::Sample>&& samples) const {
  QueryCut cut;
  cut.chunks = std::move(chunks);
  if (samples.empty()) return cut;
  cut.entries = EntryTree(std::move(samples));
  cut.origin = chunks_[cut.chunks.front()].origin;
  std::vector<BallBox> boxes;
  for (const uint32_t number : cut.chunks) {
    const QueryChunk& chunk = chunks_[number];
    const glm::dvec3 origin = chunk.origin - cut.origin;
    const BallBox& box = chunk.balls.bounds();
    boxes.push_back({glm::vec3(origin + glm::dvec3(box.low)), glm::vec3(origin + glm::dvec3(box.high)), box.radius});
  }
  cut.balls = BoxTree(boxes);
  return cut;
}

void QueryFoam::takeCut(QueryCut&& cut) {
  bytes_ += cut.treeBytes() - cut_.treeBytes();
  cut_ = std::move(cut);
}

double QueryFoam::powerOf(CellAddress cell, const glm::dvec3& point) const {
  const QueryChunk& chunk = chunks_[cell.chunk];
  return froth::powerOf(chunk.siteRadius[cell.cell], point - chunk.origin);
}

bool QueryFoam::isRowLong(const QueryChunk& chunk, uint32_t cell) {
  return chunk.neighbourOffsets[cell + 1] - chunk.neighbourOffsets[cell] > kLongRow;
}

// Over the regular triangulation greedy descent ends at the least power. It ends in any graph: each step is taken only
// to a lower number, and a site of a chunk, be it a cell or a ghost, always has the same.
bool QueryFoam::descend(CellAddress& current, const glm::dvec3& point, uint32_t longestRow) const {
  const QueryChunk* chunk = &chunks_[current.chunk];
  glm::dvec3 local = point - chunk->origin;
  double least = froth::powerOf(chunk->siteRadius[current.cell], local);
  for (;;) {
    const uint32_t begin = chunk->neighbourOffsets[current.cell], end = chunk->neighbourOffsets[current.cell + 1];
    if (end - begin > longestRow) return false;
    uint32_t best = current.cell;
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t other = chunk->neighbourAt(i);
      const double power = froth::powerOf(chunk->siteRadius[other], local);
      // On a plane: the first of its sites (shaders/foam/cell.h). Not a ghost, whose place another chunk may tell
      // otherwise: so the search ends whatever a file holds.
      const bool isFirst = power == least && other < chunk->cellCount &&
                           !foam::comesFirst(glm::vec3(chunk->siteRadius[other]) - glm::vec3(chunk->siteRadius[best]));
      if (power < least || isFirst) {
        least = power;
        best = other;
      }
    }
    if (best == current.cell) return true;
    const uint32_t from = current.chunk;
    current = cellOfSite(current, best);
    if (current.chunk == from) continue;
    chunk = &chunks_[current.chunk];
    local = point - chunk->origin;
  }
}

CellAddress QueryFoam::locateFrom(CellAddress cell, const glm::dvec3& point) const {
  descend(cell, point, UINT32_MAX);
  return cell;
}

bool QueryFoam::approach(CellAddress& cell, const glm::dvec3& point) const { return descend(cell, point, kLongRow); }

BallEntry QueryFoam::findFirstBall(const glm::dvec3& origin, const glm::dvec3& direction, double from,
                                   double to) const {
  RaySearch search{origin, direction, from, {}, RayBounds::limitOf(to)};
  RayInFoam inFoam(search, *this, cut_);
  cut_.balls.search(inFoam);
  return search.best;
}

}  // namespace froth
