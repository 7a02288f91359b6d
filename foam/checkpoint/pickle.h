// A pickle is a program. This interpreter knows only the few instructions that build a dict of tensors.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "foam/checkpoint/bad_input.h"

namespace froth {

// Element types of torch's storages.
enum class ScalarType { kFloat, kHalf, kDouble, kBFloat16, kLong, kInt, kShort, kChar, kByte, kBool };

// How a tensor lies in a storage; as the pickle states it, not yet compared with the bytes that are there.
// Shape, strides and offset count elements.
struct PickledTensor {
  ScalarType type = ScalarType::kFloat;
  std::string_view storage;  // the storage's bytes are the member `<prefix>data/<storage>`
  uint64_t storageCount = 0;
  uint64_t offset = 0;
  std::vector<uint64_t> shape, strides;  // equally long, at most kMaxTensorRank
};

inline constexpr size_t kMaxTensorRank = 8;

struct PickledEntry {
  std::string_view key;
  PickledTensor tensor;
};

// Runs `pickle`, whose result must be a dict, and returns its tensors in the dict's order; entries that are
// not tensors are left out. Keys and storage names are views into the pickle's bytes. Accepts any bytes of at
// most 256 KiB: time and memory stay within a constant times their number. Everything that such a dict does
// not need (other globals, other opcodes) is refused by name, and nothing is ever called. Thread-safe.
Result<std::vector<PickledEntry>> readPickledTensors(const NamedBytes& pickle);

}  // namespace froth
