// The order of boxes against what rays meet in them, by brute force.
#include "runtime/render/part_order.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

namespace froth::test {
namespace {

struct Interval {
  double low = 0, high = std::numeric_limits<double>::infinity();
  bool isEmpty() const { return low >= high; }
};

Interval meet(const PlacedBox& box, const glm::dvec3& origin, const glm::dvec3& direction) {
  Interval inside;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = glm::dot(origin - box.centre, box.axes[axis]), slope = glm::dot(direction, box.axes[axis]);
    const double first = (-box.half[axis] - at) / slope, second = (box.half[axis] - at) / slope;
    inside.low = std::max(inside.low, std::min(first, second));
    inside.high = std::min(inside.high, std::max(first, second));
  }
  return inside;
}

class Boxes {
 public:
  explicit Boxes(uint32_t seed) : random_(seed) {}

  double within(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  glm::dvec3 point(double reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 place = point(1);
      if (glm::length(place) > 0.1 && glm::length(place) < 1) return glm::normalize(place);
    }
  }
  std::vector<PlacedBox> some(uint32_t count) {
    std::vector<PlacedBox> boxes(count);
    for (PlacedBox& box : boxes) {
      box.centre = point(8);
      box.axes = glm::mat3_cast(glm::angleAxis(within(0, 6), direction()));
      box.half = {within(0.2, 3), within(0.2, 3), within(0.2, 3)};
    }
    return boxes;
  }

 private:
  std::mt19937 random_;
};

bool isOverlapping(const PartOrder& order, uint32_t first, uint32_t second) {
  return (order.overlaps[first] >> second & 1) != 0;
}

// Of all pairs of places, by many rays through the first box.
void expectOrder(const std::vector<PlacedBox>& boxes, const PartOrder& order, bool isParallel, const glm::dvec3& along,
                 Boxes& random, size_t& ordered) {
  for (uint32_t first = 0; first < boxes.size(); ++first) {
    for (uint32_t second = first + 1; second < boxes.size(); ++second) {
      ASSERT_EQ(isOverlapping(order, first, second), isOverlapping(order, second, first));
      if (isOverlapping(order, first, second)) continue;
      const PlacedBox &a = boxes[order.boxes[first]], &b = boxes[order.boxes[second]];
      for (int i = 0; i < 100; ++i) {
        const PlacedBox& aimed = i % 2 == 0 ? a : b;
        const glm::dvec3 target = aimed.centre + aimed.axes * (aimed.half * random.point(1));
        const glm::dvec3 direction = isParallel ? along : glm::normalize(target);
        const glm::dvec3 origin = isParallel ? target - 100.0 * along : glm::dvec3(0);
        const Interval inFirst = meet(a, origin, direction), inSecond = meet(b, origin, direction);
        if (inFirst.isEmpty() || inSecond.isEmpty()) continue;
        ++ordered;
        EXPECT_LE(inFirst.high, inSecond.low + 1e-6);
      }
    }
  }
}

TEST(PartOrder, IsThatInWhichRaysMeetBoxes) {
  size_t ordered = 0, apart = 0, pairs = 0;
  for (uint32_t seed = 1; seed <= 300; ++seed) {
    Boxes random(seed);
    const std::vector<PlacedBox> boxes = random.some(2 + seed % (gpu::kMostInstances - 1));
    for (const bool isParallel : {false, true}) {
      const glm::dvec3 along = random.direction();
      const PartOrder order = orderBoxes(boxes, isParallel ? std::optional(along) : std::nullopt);
      std::vector<uint32_t> all(order.boxes.begin(), order.boxes.begin() + static_cast<std::ptrdiff_t>(boxes.size()));
      std::ranges::sort(all);
      for (uint32_t i = 0; i < boxes.size(); ++i) ASSERT_EQ(all[i], i);
      expectOrder(boxes, order, isParallel, along, random, ordered);
      pairs += boxes.size() * (boxes.size() - 1) / 2;
      for (uint32_t place = 0; place < boxes.size(); ++place) {
        apart += boxes.size() - 1 - static_cast<size_t>(std::popcount(order.overlaps[place]));
      }
    }
  }
  std::printf("%zu of %zu pairs are apart; %zu rays met both of one\n", apart / 2, pairs, ordered);
  EXPECT_GT(ordered, 10'000u);
  EXPECT_GT(2 * apart, pairs);
}

PlacedBox boxAt(const glm::dvec3& centre, const glm::dvec3& half) { return {centre, glm::dmat3(1), half}; }

TEST(PartOrder, LetsBoxesTouch) {
  const std::vector<PlacedBox> boxes{boxAt({0, 0, 7}, {1, 1, 1}), boxAt({0, 0, 5}, {1, 1, 1})};
  const PartOrder order = orderBoxes(boxes, std::nullopt);
  EXPECT_EQ(order.boxes[0], 1u);
  EXPECT_EQ(order.overlaps[0], 0u);
}

TEST(PartOrder, OfBoxesThatMeetStaysAsGiven) {
  const std::vector<PlacedBox> boxes{boxAt({0, 0, 7}, {1, 1, 1}), boxAt({0, 0, 5.5}, {1, 1, 1})};
  const PartOrder order = orderBoxes(boxes, std::nullopt);
  EXPECT_EQ(order.boxes[0], 0u);
  EXPECT_EQ(order.overlaps[0], 2u);
  EXPECT_EQ(order.overlaps[1], 1u);
}

TEST(PartOrder, HasTheBoxAroundTheEyeFirst) {
  const std::vector<PlacedBox> boxes{boxAt({0, 0, 5}, {1, 1, 1}), boxAt({0, 0, 0}, {2, 2, 2})};
  const PartOrder order = orderBoxes(boxes, std::nullopt);
  EXPECT_EQ(order.boxes[0], 1u);
  EXPECT_EQ(order.overlaps[0], 0u);
}

// Three beams around the line of sight. The far end of each is behind the near end of the next.
TEST(PartOrder, GivesUpARoundOfBoxesThatHideEachOther) {
  std::vector<PlacedBox> boxes;
  for (int i = 0; i < 3; ++i) {
    const double angle = i * 2.0943951;
    const glm::dvec3 outwards(std::cos(angle), std::sin(angle), 0);
    const glm::dvec3 along = glm::normalize(glm::dvec3(-std::sin(angle), std::cos(angle), 0.3));
    boxes.push_back({glm::dvec3(0, 0, 10) + outwards, {along, outwards, glm::cross(along, outwards)}, {3, 0.1, 0.1}});
  }
  const PartOrder order = orderBoxes(boxes, std::nullopt);
  EXPECT_EQ(order.boxes[0], 0u);
  EXPECT_EQ(std::popcount(order.overlaps[0]), 1);
  Boxes random(1);
  size_t ordered = 0;
  expectOrder(boxes, order, false, {}, random, ordered);
  EXPECT_GT(ordered, 0u);
}

}  // namespace
}  // namespace froth::test
