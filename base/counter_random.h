// Random numbers as a pure function of (seed, purpose, index): no state, so no thread can change another's
// draw.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace froth {

// The finalizer of splitmix64 (Steele, Lea & Flood 2014).
inline uint64_t mixBits(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

// What random numbers are drawn for; streams of different purposes are independent.
enum class Purpose : uint64_t {
  kSubpixel,
  kEye,
  kDirection,
  kSite,
  kRadius,
  kDensity,
  kFrame,
  kDetail,
  kHeight,
  kAxis,
  kTemperature,
  kColour,
  kSurface,                // one stream for each surface follows
  kStart = 1 << 28,        // one stream for each parameter of a cell follows
  kPhotoOrder = 1 << 29,   // one stream for each epoch follows
  kSplit = 3 << 28,        // two streams for each step of training follow
  kCrowd = (1 << 30) - 2,  // one stream for the neighbours of crowded cells
  kDisk = (1 << 30) - 1,   // one number for each range
  kRounding = 1 << 30,     // last: one stream for each cell follows
};

class CounterRandom {
 public:
  // `stream` tells several streams of one purpose apart; only those that say so have them.
  CounterRandom(uint64_t seed, Purpose purpose, uint64_t stream = 0)
      : key_(mixBits(mixBits(seed + kGolden) + (static_cast<uint64_t>(purpose) + stream) * kGolden)) {}

  uint64_t bits(uint64_t index) const { return mixBits(key_ + (index + 1) * kGolden); }

  // [0, 1), 53 bits.
  double uniform(uint64_t index) const { return static_cast<double>(bits(index) >> 11) * 0x1p-53; }
  double uniform(uint64_t index, double low, double high) const { return low + (high - low) * uniform(index); }

  // Uniform on the unit sphere.
  glm::dvec3 direction(uint64_t index) const {
    const double z = uniform(2 * index, -1.0, 1.0);
    const double angle = uniform(2 * index + 1, 0.0, glm::two_pi<double>());
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  }

 private:
  static constexpr uint64_t kGolden = 0x9e3779b97f4a7c15ull;
  uint64_t key_;
};

}  // namespace froth
