#include "format/quantization.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "format/lattice.h"

namespace froth {
namespace {

constexpr uint32_t kMantissaBits = 23;
constexpr int kExponentBias = 127;

double signOf(double value) { return value < 0 ? -1.0 : 1.0; }

// Folds the lower half of the octahedron's square over its diagonals, or back.
glm::dvec2 foldSquare(double y, double z) { return {(1 - std::abs(z)) * signOf(y), (1 - std::abs(y)) * signOf(z)}; }

}  // namespace

float roundMantissa(float value, uint32_t bits) {
  if (bits >= kMantissaBits) return value;
  const uint32_t shift = kMantissaBits - bits;
  const uint32_t word = std::bit_cast<uint32_t>(value);
  const uint32_t tie = (word >> shift) & 1;  // to even
  const uint32_t rounded = word + ((1u << (shift - 1)) - 1) + tie;
  return std::bit_cast<float>(rounded >> shift << shift);
}

float floorMantissa(float value, uint32_t bits) {
  if (bits >= kMantissaBits) return value;
  const uint32_t shift = kMantissaBits - bits;
  return std::bit_cast<float>(std::bit_cast<uint32_t>(value) >> shift << shift);
}

// Adding 0 makes -0 into +0, which is the only zero of a lattice.
float snapToStep(float value, float step) { return step > 0 ? std::nearbyint(value / step) * step + 0.0f : value; }

double snapToStep(double value, double step) { return step > 0 ? std::nearbyint(value / step) * step + 0.0 : value; }

float commonStep(std::span<const float> values) {
  int lowest = std::numeric_limits<int>::max();
  float largest = 0;
  for (const float value : values) {
    const uint32_t bits = std::bit_cast<uint32_t>(value);
    if (bits == 0) continue;  // the only zero of a lattice is +0
    if (!std::isnormal(value)) return 0;
    const uint32_t mantissa = (bits & ((1u << kMantissaBits) - 1)) | 1u << kMantissaBits;
    const int exponent = static_cast<int>(bits >> kMantissaBits & 255) - kExponentBias - int{kMantissaBits};
    lowest = std::min(lowest, exponent + std::countr_zero(mantissa));
    largest = std::max(largest, std::abs(value));
  }
  if (largest == 0) return 1;
  const float step = std::ldexp(1.0f, lowest);
  return std::isnormal(step) && largest / step <= static_cast<float>(kMaxLatticeIndex) ? step : 0;
}

std::array<uint32_t, 2> normalIndices(glm::dvec3 normal, uint32_t bits) {
  // The axis of the octahedron is x, so that the fold lies where the shortest rotation changes its base.
  const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  glm::dvec2 square(normal.y / sum, normal.z / sum);
  if (normal.x < 0) square = foldSquare(square.x, square.y);
  const double half = (1u << (bits - 1)) - 1;  // indices 0 .. 2 half; half is the axis itself
  const auto index = [half](double value) {
    return static_cast<uint32_t>(std::nearbyint((std::min(std::max(value, -1.0), 1.0) + 1) * half));
  };
  return {index(square.x), index(square.y)};
}

glm::vec4 orientationOfNormal(std::array<uint32_t, 2> indices, uint32_t bits) {
  const double half = (1u << (bits - 1)) - 1;
  double y = (indices[0] - half) / half, z = (indices[1] - half) / half;
  const double x = 1 - std::abs(y) - std::abs(z);
  if (x < 0) {
    const glm::dvec2 folded = foldSquare(y, z);
    y = folded.x + 0.0;  // -0 into +0: on the square's border two pairs of indices are the same normal
    z = folded.y + 0.0;
  }
  const double length = std::sqrt(x * x + y * y + z * z);
  const glm::dvec3 normal(x / length, y / length, z / length);
  // The quaternion q with q n q^-1 = +x, up to a turn by pi about z where n is nearer to -x. Rows of its
  // matrix: n, t, b.
  const double w = std::sqrt((1 + std::abs(normal.x)) / 2);
  const double s = 0.5 / w;
  if (normal.x >= 0) return glm::vec4(w, 0, normal.z * s, -normal.y * s);
  return glm::vec4(-normal.y * s, normal.z * s, 0, w);
}

std::optional<std::array<uint32_t, 2>> findNormalIndices(const glm::vec4& orientation, uint32_t bits) {
  const glm::dvec4 q(orientation);  // w, x, y, z
  const glm::dvec3 normal(1 - 2 * (q.z * q.z + q.w * q.w), 2 * (q.y * q.z - q.x * q.w), 2 * (q.y * q.w + q.x * q.z));
  const std::array<uint32_t, 2> indices = normalIndices(normal, bits);
  if (orientationOfNormal(indices, bits) != orientation) return std::nullopt;
  return indices;
}

}  // namespace froth
