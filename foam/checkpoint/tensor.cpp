#include "foam/checkpoint/tensor.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/ranges.h>

#include "foam/checkpoint/little_endian.h"

namespace froth {
namespace {

struct Half {
  uint16_t bits;
};
struct BFloat16 {
  uint16_t bits;
};

double toReal(float value) { return value; }
double toReal(double value) { return value; }
double toReal(BFloat16 value) { return std::bit_cast<float>(uint32_t{value.bits} << 16); }

double toReal(Half value) {
  constexpr int kMantissaBits = 10, kBias = 15, kMaxExponent = 31;
  const int exponent = value.bits >> kMantissaBits & kMaxExponent;
  const int mantissa = value.bits & ((1 << kMantissaBits) - 1);
  const double sign = value.bits & 0x8000 ? -1.0 : 1.0;
  if (exponent == kMaxExponent) {
    return mantissa ? std::numeric_limits<double>::quiet_NaN() : sign * std::numeric_limits<double>::infinity();
  }
  const bool isNormal = exponent > 0;
  const int significand = isNormal ? mantissa + (1 << kMantissaBits) : mantissa;
  return sign * std::ldexp(significand, (isNormal ? exponent : 1) - kBias - kMantissaBits);
}

uint64_t elementSize(ScalarType type) {
  switch (type) {
    case ScalarType::kDouble:
    case ScalarType::kLong:
      return 8;
    case ScalarType::kFloat:
    case ScalarType::kInt:
      return 4;
    case ScalarType::kHalf:
    case ScalarType::kBFloat16:
    case ScalarType::kShort:
      return 2;
    case ScalarType::kChar:
    case ScalarType::kByte:
    case ScalarType::kBool:
      return 1;
  }
  return 0;
}

bool isFloating(ScalarType type) {
  return type == ScalarType::kFloat || type == ScalarType::kDouble || type == ScalarType::kHalf ||
         type == ScalarType::kBFloat16;
}

// Smallest number of elements a storage must have; false where it does not fit into 64 bits.
bool findExtent(const PickledTensor& tensor, uint64_t& extent) {
  extent = tensor.offset;
  for (size_t i = 0; i < tensor.shape.size(); ++i) {
    uint64_t reach = 0;
    if (tensor.shape[i] == 0) {
      extent = 0;
      return true;
    }
    if (__builtin_mul_overflow(tensor.shape[i] - 1, tensor.strides[i], &reach) ||
        __builtin_add_overflow(extent, reach, &extent)) {
      return false;
    }
  }
  return !__builtin_add_overflow(extent, uint64_t{1}, &extent);
}

bool multiplyShape(std::span<const uint64_t> shape, uint64_t& count) {
  count = 1;
  for (const uint64_t size : shape) {
    if (__builtin_mul_overflow(count, size, &count)) {
      return false;
    }
  }
  return true;
}

bool isContiguous(const TensorView& view) {
  uint64_t expected = 1;
  for (size_t i = view.shape.size(); i-- > 0;) {
    if (view.shape[i] != 1 && view.strides[i] != expected) {
      return false;
    }
    expected *= view.shape[i];
  }
  return true;
}

template <class Element, class Real>
void copyStrided(const TensorView& view, Real* out) {
  const size_t rank = view.shape.size();
  std::vector<uint64_t> index(rank, 0);
  uint64_t element = view.offset;
  for (uint64_t i = 0; i < view.count; ++i) {
    out[i] = static_cast<Real>(toReal(loadLittleEndian<Element>(view.storage.data() + element * sizeof(Element))));
    for (size_t axis = rank; axis-- > 0;) {
      element += view.strides[axis];
      if (++index[axis] < view.shape[axis]) {
        break;
      }
      element -= view.shape[axis] * view.strides[axis];
      index[axis] = 0;
    }
  }
}

}  // namespace

Result<TensorView> viewTensor(std::string_view file, std::string_view key, const PickledTensor& tensor,
                              std::span<const uint8_t> storage) {
  if (!isFloating(tensor.type)) {
    return badInput(file, "tensor '{}' holds integers; save it as float32, float64, float16 or bfloat16", key);
  }
  const uint64_t size = elementSize(tensor.type);
  if (storage.size() % size != 0 || storage.size() / size != tensor.storageCount) {
    return badInput(file, "tensor '{}': its storage {} has {} bytes, expected {} elements of {} bytes; save it again",
                    key, quoted(tensor.storage), storage.size(), tensor.storageCount, size);
  }
  uint64_t extent = 0, count = 0;
  if (!findExtent(tensor, extent) || !multiplyShape(tensor.shape, count) || extent > tensor.storageCount) {
    return badInput(
        file, "tensor '{}' of shape {}, strides {}, offset {} leaves its storage of {} elements; save it again", key,
        describeShape(tensor.shape), describeShape(tensor.strides), tensor.offset, tensor.storageCount);
  }
  return TensorView{std::string(key), tensor.type, storage, tensor.offset, tensor.shape, tensor.strides, count};
}

TensorView rowsOf(const TensorView& view, uint64_t first, uint64_t count) {
  TensorView rows = view;
  rows.offset += first * view.strides[0];
  rows.shape[0] = count;
  rows.count = view.count / view.shape[0] * count;
  return rows;
}

template <class Real>
void copyElements(const TensorView& view, Real* out) {
  if (std::is_same_v<Real, float> && view.type == ScalarType::kFloat && isContiguous(view)) {
    if (view.count > 0) {
      std::memcpy(out, view.storage.data() + view.offset * sizeof(float), view.count * sizeof(float));
    }
    return;
  }
  switch (view.type) {
    case ScalarType::kDouble:
      copyStrided<double>(view, out);
      return;
    case ScalarType::kHalf:
      copyStrided<Half>(view, out);
      return;
    case ScalarType::kBFloat16:
      copyStrided<BFloat16>(view, out);
      return;
    default:
      copyStrided<float>(view, out);
  }
}

template void copyElements(const TensorView& view, float* out);
template void copyElements(const TensorView& view, double* out);

std::string describeShape(std::span<const uint64_t> shape) { return fmt::format("[{}]", fmt::join(shape, ", ")); }

}  // namespace froth
