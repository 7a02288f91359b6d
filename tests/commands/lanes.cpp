#include "tests/commands/lanes.h"

#include <algorithm>

namespace froth::test {
namespace {

using namespace spirv;
using Number = std::optional<uint32_t>;

Number computeKnown(Op op, uint32_t a, uint32_t b) {
  switch (op) {
    case kIAdd:
      return a + b;
    case kISub:
      return a - b;
    case kIMul:
      return a * b;
    case kUDiv:
      return b == 0 ? Number() : a / b;
    case kUMod:
      return b == 0 ? Number() : a % b;
    case kLogicalNot:
      return !a;
    case kLogicalOr:
      return a | b;
    case kLogicalAnd:
      return a & b;
    case kIEqual:
      return a == b;
    case kINotEqual:
      return a != b;
    case kUGreaterThan:
      return a > b;
    case kUGreaterThanEqual:
      return a >= b;
    case kULessThan:
      return a < b;
    case kULessThanEqual:
      return a <= b;
    case kSLessThan:
      return static_cast<int32_t>(a) < static_cast<int32_t>(b);
    case kShiftRightLogical:
      return b < 32 ? a >> b : Number();
    case kShiftLeftLogical:
      return b < 32 ? a << b : Number();
    case kBitwiseOr:
      return a | b;
    case kBitwiseXor:
      return a ^ b;
    case kBitwiseAnd:
      return a & b;
    default:
      return {};
  }
}

Number computeLane(Op op, Number a, Number b) {
  if (op == kLogicalAnd && (a == 0u || b == 0u)) return 0;
  if (op == kLogicalOr && (a == 1u || b == 1u)) return 1;
  return a && b ? computeKnown(op, *a, *b) : Number();
}

}  // namespace

Value LaneStore::keep(Lanes lanes) {
  if (std::ranges::none_of(lanes, [](const Number& lane) { return lane.has_value(); })) return nullptr;
  return &*kept_.insert(std::move(lanes)).first;
}

Value LaneStore::compute(Op op, Value a, Value b) {
  if (!a && !b) return nullptr;
  Lanes result(threads_);
  for (size_t i = 0; i < threads_; ++i) result[i] = computeLane(op, laneOf(a, i), laneOf(b, i));
  return keep(std::move(result));
}

Value LaneStore::select(Value condition, Value yes, Value no) {
  if (!condition) return nullptr;
  Lanes result(threads_);
  for (size_t i = 0; i < threads_; ++i) {
    if (const Number lane = laneOf(condition, i)) result[i] = laneOf(*lane ? yes : no, i);
  }
  return keep(std::move(result));
}

Value LaneStore::join(Value a, const Mask& fromA, Value b, const Mask& fromB) {
  if (a == b || (!a && !b)) return a;
  Lanes result(threads_);
  for (size_t i = 0; i < threads_; ++i) {
    const Number laneA = laneOf(a, i), laneB = laneOf(b, i);
    if (fromA[i] && (!fromB[i] || laneA == laneB)) result[i] = laneA;
    if (fromB[i] && !fromA[i]) result[i] = laneB;
  }
  return keep(std::move(result));
}

}  // namespace froth::test
