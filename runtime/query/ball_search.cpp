// Searches of a foam that need no walk: the power cell of a point, and the ball that a ray enters first.
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
void forEachCell(uint32_t item, uint32_t first, uint32_t end, const Visit& visit) {
  const uint32_t begin = first + item * kBallsPerBox;
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
      : RayInBoxes(asking, foam.chunk(numberOfChunk).origin, foam.chunk(numberOfChunk).balls.live),
        chunk(foam.chunk(numberOfChunk)),
        number(numberOfChunk),
        localOrigin(asking.origin - chunk.origin) {}

  void visit(uint32_t item) {
    search.best.asked += kBallsPerBox;
    forEachCell(item, 0, chunk.liveCount, [&](uint32_t cell) {
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
      : RayInBoxes(asking, inCut.origin, inCut.balls.live), foam(inFoam), cut(inCut) {}

  void visit(uint32_t item) {
    RayInChunk inChunk(search, foam, cut.chunks[item]);
    inChunk.chunk.balls.live.search(inChunk);
  }
};

struct PowerSearch {
  const QueryFoam& foam;
  glm::dvec3 point;
  CellAddress best;
  double least;
  float limit;

  glm::dvec3 placeOf(CellAddress cell) const {
    const QueryChunk& chunk = foam.chunk(cell.chunk);
    return chunk.origin + chunk.siteOf(cell.cell);
  }
  // On a plane: the first of its sites (shaders/foam/cell.h).
  void offer(CellAddress cell, double power) {
    if (power > least || cell == best) return;
    if (power == least && foam::comesFirst(placeOf(cell) - placeOf(best))) return;
    best = cell;
    least = power;
    limit = PowerBounds::limitOf(power);
  }
};

struct PowerInBoxes {
  PowerSearch& search;
  PowerBounds power;

  PowerInBoxes(PowerSearch& asking, const glm::dvec3& frame, const BoxTree& tree)
      : search(asking), power(asking.point - frame, tree.bounds()) {}
  void measure(const BoxTree::Node& node, float (&bounds)[BoxTree::kWidth]) const { power.measure(node, bounds); }
  float limit() const { return search.limit; }
};

struct PowerInChunk : PowerInBoxes {
  const QueryChunk& chunk;
  CellAddress first;
  uint32_t end;  // of the tree's cells
  glm::dvec3 local;

  PowerInChunk(PowerSearch& asking, const BoxTree& tree, CellAddress from, uint32_t to)
      : PowerInBoxes(asking, asking.foam.chunk(from.chunk).origin, tree),
        chunk(asking.foam.chunk(from.chunk)),
        first(from),
        end(to),
        local(asking.point - chunk.origin) {}

  void visit(uint32_t item) {
    forEachCell(item, first.cell, end, [&](uint32_t cell) {
      search.offer({first.chunk, cell}, powerOf(chunk.siteRadius[cell], local));
    });
  }
};

struct PowerInFoam : PowerInBoxes {
  const QueryCut& cut;
  bool isLive;

  PowerInFoam(PowerSearch& asking, const QueryCut& inCut, bool ofLive)
      : PowerInBoxes(asking, inCut.origin, ofLive ? inCut.balls.live : inCut.balls.others),
        cut(inCut),
        isLive(ofLive) {}

  void visit(uint32_t item) {
    const uint32_t number = cut.chunks[item];
    const QueryChunk& chunk = search.foam.chunk(number);
    const BoxTree& tree = isLive ? chunk.balls.live : chunk.balls.others;
    PowerInChunk inChunk(search, tree, {number, isLive ? 0 : chunk.liveCount},
                         isLive ? chunk.liveCount : chunk.cellCount);
    tree.search(inChunk);
  }
};

}  // namespace

QueryCut QueryFoam::makeTrees(std::vector<uint32_t>&& chunks, std::vector<EntryTree::Sample>&& samples) const {
  QueryCut cut;
  cut.chunks = std::move(chunks);
  if (samples.empty()) return cut;
  cut.entries = EntryTree(std::move(samples));
  cut.origin = chunks_[cut.chunks.front()].origin;
  std::vector<BallBox> live, others;
  for (const uint32_t number : cut.chunks) {
    const QueryChunk& chunk = chunks_[number];
    const glm::dvec3 origin = chunk.origin - cut.origin;
    const auto move = [&](const BallBox& box) {
      return BallBox{glm::vec3(origin + glm::dvec3(box.low)), glm::vec3(origin + glm::dvec3(box.high)), box.radius};
    };
    live.push_back(move(chunk.balls.live.bounds()));
    others.push_back(move(chunk.balls.others.bounds()));
  }
  cut.balls = {BoxTree(live), BoxTree(others)};
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

// Greedy descent of the power. Over the regular triangulation it ends at the least one. Ends in any graph: each step is
// taken only to a lower number, and a site of a chunk, be it a cell or a ghost, always has the same.
bool QueryFoam::descend(CellAddress& current, const glm::dvec3& point) const {
  const QueryChunk* chunk = &chunks_[current.chunk];
  glm::dvec3 local = point - chunk->origin;
  double least = froth::powerOf(chunk->siteRadius[current.cell], local);
  for (;;) {
    if (isRowLong(*chunk, current.cell)) return false;
    uint32_t best = current.cell;
    const uint32_t end = chunk->neighbourOffsets[current.cell + 1];
    for (uint32_t i = chunk->neighbourOffsets[current.cell]; i < end; ++i) {
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
  return descend(cell, point) ? cell : findLeastPower(cell, point);
}

// Of all shown cells; `cell` is one that is probably near.
CellAddress QueryFoam::findLeastPower(CellAddress cell, const glm::dvec3& point) const {
  const double power = powerOf(cell, point);
  PowerSearch search{*this, point, cell, power, PowerBounds::limitOf(power)};
  PowerInFoam live(search, cut_, true), others(search, cut_, false);
  cut_.balls.live.search(live);
  cut_.balls.others.search(others);
  return search.best;
}

BallEntry QueryFoam::findFirstBall(const glm::dvec3& origin, const glm::dvec3& direction, double from,
                                   double to) const {
  RaySearch search{origin, direction, from, {}, RayBounds::limitOf(to)};
  RayInFoam inFoam(search, *this, cut_);
  cut_.balls.live.search(inFoam);
  return search.best;
}

}  // namespace froth
