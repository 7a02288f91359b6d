// Small symmetric systems of least squares.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace froth {

// Solves matrix x = right for `columns` right sides at once; matrix [n * n] positive definite, its upper half is read
// and both are overwritten; right [n * columns] becomes x. False, and nothing useful, where the matrix is not definite.
inline bool solveDefinite(std::span<double> matrix, std::span<double> right, size_t n, size_t columns) {
  for (size_t j = 0; j < n; ++j) {
    for (size_t i = 0; i <= j; ++i) {
      double sum = matrix[i * n + j];
      for (size_t k = 0; k < i; ++k) sum -= matrix[k * n + i] * matrix[k * n + j];
      if (i == j && !(sum > 0)) return false;
      matrix[i * n + j] = i == j ? std::sqrt(sum) : sum / matrix[i * n + i];
    }
  }
  for (size_t c = 0; c < columns; ++c) {
    for (size_t j = 0; j < n; ++j) {
      for (size_t k = 0; k < j; ++k) right[j * columns + c] -= matrix[k * n + j] * right[k * columns + c];
      right[j * columns + c] /= matrix[j * n + j];
    }
    for (size_t j = n; j-- > 0;) {
      for (size_t k = j + 1; k < n; ++k) right[j * columns + c] -= matrix[j * n + k] * right[k * columns + c];
      right[j * columns + c] /= matrix[j * n + j];
    }
  }
  return true;
}

}  // namespace froth
