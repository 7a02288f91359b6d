// Tensors as views of storages: any strides and offset, storages shared, elements of any floating type.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "foam/checkpoint/pickle.h"

namespace froth {

// A tensor of a floating type whose every element was found to lie inside `storage`.
struct TensorView {
  std::string key;
  ScalarType type = ScalarType::kFloat;
  std::span<const uint8_t> storage;
  uint64_t offset = 0;                   // [elements]
  std::vector<uint64_t> shape, strides;  // [elements]; a stride of 0 repeats
  uint64_t count = 0;                    // product of the shape
};

// `storage`: the bytes of the tensor's storage. Refuses integer types, storages whose size is not what the
// pickle states, views that leave their storage and counts beyond 64 bits.
Result<TensorView> viewTensor(std::string_view file, std::string_view key, const PickledTensor& tensor,
                              std::span<const uint8_t> storage);

// `count` of the view's rows (along its first axis) from `first` on.
TensorView rowsOf(const TensorView& view, uint64_t first, uint64_t count);

// Writes the view's elements in row-major order; `out` holds `view.count` of them. Real: float or double.
template <class Real>
void copyElements(const TensorView& view, Real* out);

// "[3, 8, 24]", for messages.
std::string describeShape(std::span<const uint64_t> shape);

}  // namespace froth
