#include "runtime/query/box_tree.h"

namespace froth {
namespace {

// Of eight boxes at most; places without one hold an empty box.
BoxTree::Node packBoxes(std::span<const BallBox> boxes) {
  BoxTree::Node node;
  for (uint32_t i = 0; i < BoxTree::kWidth; ++i) {
    const BallBox box = i < boxes.size() ? boxes[i] : BallBox{};
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][i] = box.low[axis];
      node.high[axis][i] = box.high[axis];
    }
    node.radius[i] = box.radius;
  }
  return node;
}

}  // namespace

BoxTree::BoxTree(std::span<const BallBox> items) {
  std::vector<BallBox> boxes(items.begin(), items.end());
  for (const BallBox& box : boxes) bounds_.add(box);
  size_t total = 0;
  for (size_t count = boxes.size(); count > 1 || total == 0; total += count) {
    if (count == 0) return;
    count = (count + kWidth - 1) / kWidth;
  }
  nodes_.reserve(total);
  counts_[0] = static_cast<uint32_t>(boxes.size());
  do {
    std::vector<BallBox> above;
    starts_[++levels_] = static_cast<uint32_t>(nodes_.size());
    for (size_t first = 0; first < boxes.size(); first += kWidth) {
      const auto run = std::span(boxes).subspan(first, std::min<size_t>(kWidth, boxes.size() - first));
      nodes_.push_back(packBoxes(run));
      BallBox& all = above.emplace_back();
      for (const BallBox& box : run) all.add(box);
    }
    counts_[levels_] = static_cast<uint32_t>(above.size());
    boxes = std::move(above);
  } while (boxes.size() > 1);
}

}  // namespace froth
