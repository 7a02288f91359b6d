// Arrays of floats and of float vectors as plain floats.
#pragma once

#include <span>
#include <vector>

namespace froth {

// The numbers of an array, which must outlive them.
template <class Vector>
std::span<const float> floatsOf(const std::vector<Vector>& array) {
  static_assert(sizeof(Vector) % sizeof(float) == 0);
  return {reinterpret_cast<const float*>(array.data()), array.size() * (sizeof(Vector) / sizeof(float))};
}
template <class Vector>
std::span<float> floatsOf(std::vector<Vector>& array) {
  static_assert(sizeof(Vector) % sizeof(float) == 0);
  return {reinterpret_cast<float*>(array.data()), array.size() * (sizeof(Vector) / sizeof(float))};
}

}  // namespace froth
