// Arrays compared bit by bit, NaN and signed zeros included. Empty ones are the same.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace froth {

template <class T>
bool haveSameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

}  // namespace froth
