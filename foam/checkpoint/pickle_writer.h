// The pickle of a dict of tensors, byte for byte as torch.save writes it (protocol 2).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "foam/checkpoint/pickle.h"

namespace froth {

// A contiguous tensor in a storage of its own.
struct TensorDeclaration {
  std::string_view key;
  ScalarType type = ScalarType::kFloat;  // kFloat or kInt
  std::vector<uint64_t> shape;           // 1 to 3 sizes, their product below 2^63
};

// The storage of tensors[i] is called "i". At most 20 tensors: the memo then needs only its short opcodes.
std::string pickleTensors(std::span<const TensorDeclaration> tensors);

}  // namespace froth
