// Numbers as the threads of a workgroup have them: of each thread its own, where it is known.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "tests/commands/spirv.h"

namespace froth::test {

using Lanes = std::vector<std::optional<uint32_t>>;
using Mask = std::vector<bool>;  // of threads
using Value = const Lanes*;      // nullptr: known of no thread

// Keeps each row of numbers once: equal ones have one address.
class LaneStore {
 public:
  explicit LaneStore(size_t threads) : threads_(threads) {}
  size_t threads() const { return threads_; }

  Value keep(Lanes lanes);
  Value constant(uint32_t number) { return keep(Lanes(threads_, number)); }

  // Of an instruction with one or two operands of 32 bits; nullptr of one that is not computed here.
  Value compute(spirv::Op op, Value a, Value b);
  Value select(Value condition, Value yes, Value no);
  // Where paths meet: of threads that may have come by both, only what both know.
  Value join(Value a, const Mask& fromA, Value b, const Mask& fromB);

 private:
  size_t threads_;
  std::set<Lanes> kept_;
};

inline std::optional<uint32_t> laneOf(Value value, size_t lane) { return value ? (*value)[lane] : std::nullopt; }

}  // namespace froth::test
