// A tree over balls that come along a curve: a few in a row are an item, eight items a node, eight nodes a node above,
// up to one root. It holds nothing but the boxes of centres and the greatest radii, 28 bytes for an item and an eighth
// more above.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

struct BallBox {
  glm::vec3 low{HUGE_VALF}, high{-HUGE_VALF};  // of the centres
  float radius = 0;                            // the greatest

  void add(const BallBox& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
    radius = std::max(radius, other.radius);
  }
};

class BoxTree {
 public:
  static constexpr uint32_t kWidth = 8;

  // Of eight items, or of eight nodes below.
  struct Node {
    float low[3][kWidth], high[3][kWidth], radius[kWidth];
  };

  BoxTree() = default;
  explicit BoxTree(std::span<const BallBox> items);

  const BallBox& bounds() const { return bounds_; }
  uint64_t bytes() const { return nodes_.capacity() * sizeof(Node); }

  // Items by ascending bound as far as nodes tell it. A Query has
  //   void measure(const Node&, float (&bounds)[kWidth]): a lower bound for what each of the boxes holds
  //   float limit() const: greater bounds are left out
  //   void visit(uint32_t item): may lower the limit
  template <class Query>
  void search(Query& query) const;

 private:
  static constexpr uint32_t kMostLevels = 11;  // 8^11 > 2^32

  struct Step {
    float bound;
    uint32_t level, index;  // level 0: an item
  };

  std::vector<Node> nodes_;  // of level 1, which hold items, first; the root is the last
  std::array<uint32_t, kMostLevels + 1> starts_{}, counts_{};  // [level]; counts_[0]: items
  uint32_t levels_ = 0;
  BallBox bounds_;
};

template <class Query>
void BoxTree::search(Query& query) const {
  std::array<Step, kMostLevels * kWidth> stack;
  size_t size = 0;
  if (levels_ > 0) stack[size++] = {-HUGE_VALF, levels_, 0};
  while (size > 0) {
    const Step step = stack[--size];
    if (step.bound > query.limit()) continue;
    if (step.level == 0) {
      query.visit(step.index);
      continue;
    }
    float bounds[kWidth];
    query.measure(nodes_[starts_[step.level] + step.index], bounds);
    const uint32_t first = kWidth * step.index, below = step.level - 1;
    const uint32_t count = std::min(kWidth, counts_[below] - first);
    const size_t base = size;
    for (uint32_t i = 0; i < count; ++i) {
      if (bounds[i] > query.limit()) continue;
      size_t place = size++;  // the least on top
      for (; place > base && stack[place - 1].bound < bounds[i]; --place) stack[place] = stack[place - 1];
      stack[place] = {bounds[i], below, first + i};
    }
  }
}

}  // namespace froth
