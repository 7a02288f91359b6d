// Patterns of the plane from which materials are mixed. All are deterministic and continuous unless said
// otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace froth {

// Smooth noise of unit wavelength, [-1, 1].
double gradientNoise(const glm::dvec2& x, uint32_t seed);

// Sum of `octaves` noises, each of half the wavelength and half the height of the one before, about [-1, 1].
double fractalNoise(const glm::dvec2& x, int octaves, uint32_t seed);

// A constant in [0, 1) for each square of the unit lattice.
double latticeHash(int64_t i, int64_t j, uint32_t seed);

// Distances to the two nearest points of a jittered unit lattice, and the nearest one's lattice hash.
struct Bubbles {
  double nearest, second, hash;
};
Bubbles findBubbles(const glm::dvec2& x, uint32_t seed);

// 0 below `low`, 1 above `high`, smooth between. low < high.
inline double smoothRamp(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// 1 inside [low, high], falling to 0 over `blur` centred on either end.
inline double smoothInterval(double low, double high, double blur, double x) {
  return smoothRamp(low - 0.5 * blur, low + 0.5 * blur, x) * (1 - smoothRamp(high - 0.5 * blur, high + 0.5 * blur, x));
}

// Distance to the nearest multiple of `period`.
inline double distanceToMultiple(double x, double period) { return std::abs(x - period * std::round(x / period)); }

}  // namespace froth
