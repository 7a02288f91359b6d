#include "tests/stream/level_dag.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace froth::test {

namespace {

// A chunk while levels are made: the ball around its live cells and the balls of all that is finer. Its own live cells
// lie in a box in that ball.
struct Node {
  uint32_t chunk = 0;
  glm::dvec3 centre{0};
  double radius = 0;
  double error = 0;  // of the group that made it
};

class DagMaker {
 public:
  DagMaker(uint64_t seed, const DagShape& shape) : random_(seed), boxRandom_(seed), shape_(shape) {}

  LevelDag make() {
    std::vector<Node> nodes = makeFinest();
    uint32_t level = 0;
    while (nodes.size() > shape_.floorChunks) nodes = makeCoarser(nodes, level++);
    return putFloorFirst();
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  uint32_t pick(uint32_t low, uint32_t high) { return std::uniform_int_distribution<uint32_t>(low, high)(random_); }

  Box boxWithin(const glm::dvec3& centre, double radius) {
    std::uniform_real_distribution<double> extent(0.1 * radius / std::sqrt(3.0), radius / std::sqrt(3.0));
    Box box;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double at = centre[static_cast<int>(axis)];
      box.min[axis] = at - extent(boxRandom_);
      box.max[axis] = at + extent(boxRandom_);
    }
    return box;
  }

  uint32_t addChunk(uint32_t level, uint32_t madeBy, const glm::dvec3& centre, double radius) {
    dag_.levels.push_back({level, madeBy, kNoGroup});
    dag_.bytes.push_back(pick(50, 150));
    dag_.cells.push_back(pick(5, 15));
    dag_.liveBoxes.push_back(boxWithin(centre, radius));
    return static_cast<uint32_t>(dag_.levels.size() - 1);
  }

  // Rows of a square, to and fro.
  std::vector<Node> makeFinest() {
    const auto side = static_cast<uint32_t>(std::ceil(std::sqrt(shape_.finestChunks)));
    dag_.extent = side;
    std::vector<Node> nodes;
    for (uint32_t i = 0; i < shape_.finestChunks; ++i) {
      const uint32_t row = i / side, column = row % 2 == 0 ? i % side : side - 1 - i % side;
      const glm::dvec3 centre(column + 0.5, row + 0.5, 0);
      const double radius = uniform(0.5, 0.8);
      nodes.push_back({addChunk(0, kNoGroup, centre, radius), centre, radius, 0});
    }
    return nodes;
  }

  std::vector<Node> makeCoarser(const std::vector<Node>& fine, uint32_t level) {
    std::vector<Node> coarse;
    for (size_t begin = 0; begin < fine.size();) {
      const size_t left = fine.size() - begin;
      const size_t count = left <= 3 ? left : std::min<size_t>(pick(2, shape_.mostInGroup), left);
      const Node whole = addGroup({fine.data() + begin, count}, level);
      const auto group = static_cast<uint32_t>(dag_.groups.size() - 1);
      for (size_t i = 0; i < std::max<size_t>(1, count / 2); ++i) {
        coarse.push_back(whole);
        coarse.back().chunk = addChunk(level + 1, group, whole.centre, whole.radius);
      }
      begin += count;
    }
    return coarse;
  }

  Node addGroup(std::span<const Node> fine, uint32_t level) {
    Node whole;
    for (const Node& node : fine) {
      whole.centre += node.centre / static_cast<double>(fine.size());
      whole.error = std::max(whole.error, node.error);
      dag_.levels[node.chunk].in = static_cast<uint32_t>(dag_.groups.size());
    }
    for (const Node& node : fine) {
      whole.radius = std::max(whole.radius, glm::length(node.centre - whole.centre) + node.radius);
    }
    whole.error = whole.error == 0 ? uniform(0.01, 0.02) : whole.error * uniform(1.1, 3);
    dag_.groups.push_back({{whole.centre.x, whole.centre.y, whole.centre.z}, whole.radius, whole.error, level});
    return whole;
  }

  LevelDag putFloorFirst() {
    std::vector<uint32_t> order(dag_.levels.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order,
                             [&](uint32_t a, uint32_t b) { return dag_.levels[a].level > dag_.levels[b].level; });
    LevelDag sorted = dag_;
    for (size_t i = 0; i < order.size(); ++i) {
      sorted.levels[i] = dag_.levels[order[i]];
      sorted.bytes[i] = dag_.bytes[order[i]];
      sorted.cells[i] = dag_.cells[order[i]];
      sorted.liveBoxes[i] = dag_.liveBoxes[order[i]];
    }
    return sorted;
  }

  std::mt19937_64 random_, boxRandom_;
  DagShape shape_;
  LevelDag dag_;
};

}  // namespace

LevelDag makeLevelDag(uint64_t seed, const DagShape& shape) { return DagMaker(seed, shape).make(); }

StreamEye makeEye(uint64_t seed, const LevelDag& dag) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  StreamEye eye;
  eye.position = {uniform(-0.2, 1.2) * dag.extent, uniform(-0.2, 1.2) * dag.extent, uniform(-1, 3)};
  if (uniform(0, 1) < 0.2) {
    eye.pixelSize = uniform(0.005, 0.1);  // orthographic
  } else {
    eye.pixelAngle = std::exp(uniform(-7, -3));
    eye.pixelSize = eye.pixelAngle * 0.1;
  }
  if (uniform(0, 1) < 0.2) eye.radius = uniform(0, 1);
  eye.detail = uniform(0.5, 2);
  if (uniform(0, 1) < 0.5) {  // looks along the square
    const double turn = uniform(0, 6.28), half = uniform(0.2, 1);
    eye.sight[0] = {{std::sin(turn + half), -std::cos(turn + half), 0}, 0};
    eye.sight[1] = {{-std::sin(turn - half), std::cos(turn - half), 0}, 0};
  }
  return eye;
}

}  // namespace froth::test
