// What lies on the stack of the pickle interpreter, and the globals it knows.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "baker/checkpoint/pickle.h"

namespace froth {

using Ref = uint32_t;  // index of a value; values live until the program ends, so cycles and depth do no harm

struct None {};  // also floats, which nothing reads
struct Tuple {
  std::vector<Ref> items;
};
struct List {};  // nothing reads what is in one
struct Dict {
  std::vector<std::pair<Ref, Ref>> items;
};
enum class Callable { kOrderedDict, kRebuildTensor, kStorage };
struct Global {
  Callable callable;
  ScalarType type = ScalarType::kFloat;  // of a storage class
};
struct Storage {
  ScalarType type;
  std::string_view key;
  uint64_t count;
};
using Value = std::variant<None, bool, int64_t, std::string_view, Tuple, List, Dict, Global, Storage, PickledTensor>;

struct KnownGlobal {
  std::string_view module, name;
  Global global;
};
inline constexpr KnownGlobal kKnownGlobals[] = {
    {"collections", "OrderedDict", {Callable::kOrderedDict}},
    {"torch._utils", "_rebuild_tensor_v2", {Callable::kRebuildTensor}},
    {"torch", "FloatStorage", {Callable::kStorage, ScalarType::kFloat}},
    {"torch", "HalfStorage", {Callable::kStorage, ScalarType::kHalf}},
    {"torch", "DoubleStorage", {Callable::kStorage, ScalarType::kDouble}},
    {"torch", "BFloat16Storage", {Callable::kStorage, ScalarType::kBFloat16}},
    {"torch", "LongStorage", {Callable::kStorage, ScalarType::kLong}},
    {"torch", "IntStorage", {Callable::kStorage, ScalarType::kInt}},
    {"torch", "ShortStorage", {Callable::kStorage, ScalarType::kShort}},
    {"torch", "CharStorage", {Callable::kStorage, ScalarType::kChar}},
    {"torch", "ByteStorage", {Callable::kStorage, ScalarType::kByte}},
    {"torch", "BoolStorage", {Callable::kStorage, ScalarType::kBool}},
};

}  // namespace froth
