#include "baker/synth/procedural_textures.h"

#include "base/counter_random.h"

namespace froth {

using glm::dvec2;

double latticeHash(int64_t i, int64_t j, uint32_t seed) {
  const uint64_t lattice = static_cast<uint64_t>(i) * 0x9e3779b97f4a7c15ull ^ mixBits(static_cast<uint64_t>(j) + seed);
  return static_cast<double>(mixBits(lattice) >> 11) * 0x1p-53;
}

double gradientNoise(const dvec2& x, uint32_t seed) {
  const double fx = std::floor(x.x), fy = std::floor(x.y);
  const auto corner = [&](int dx, int dy) {
    const double angle =
        glm::two_pi<double>() * latticeHash(static_cast<int64_t>(fx) + dx, static_cast<int64_t>(fy) + dy, seed);
    return std::cos(angle) * (x.x - fx - dx) + std::sin(angle) * (x.y - fy - dy);
  };
  const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const double u = fade(x.x - fx), v = fade(x.y - fy);
  return 1.4 * glm::mix(glm::mix(corner(0, 0), corner(1, 0), u), glm::mix(corner(0, 1), corner(1, 1), u), v);
}

double fractalNoise(const dvec2& x, int octaves, uint32_t seed) {
  double sum = 0, scale = 1;
  for (int octave = 0; octave < octaves; ++octave, scale *= 2) {
    sum += gradientNoise(x * scale, seed + static_cast<uint32_t>(octave)) / scale;
  }
  return sum * 0.6;
}

Bubbles findBubbles(const dvec2& x, uint32_t seed) {
  const auto i = static_cast<int64_t>(std::floor(x.x)), j = static_cast<int64_t>(std::floor(x.y));
  Bubbles found{1e9, 1e9, 0};
  for (int64_t b = j - 1; b <= j + 1; ++b) {
    for (int64_t a = i - 1; a <= i + 1; ++a) {
      const dvec2 point(static_cast<double>(a) + 0.15 + 0.7 * latticeHash(a, b, seed),
                        static_cast<double>(b) + 0.15 + 0.7 * latticeHash(a, b, seed + 1));
      const double distance = glm::length(x - point);
      if (distance < found.nearest) {
        found = {distance, found.nearest, latticeHash(a, b, seed + 2)};
      } else {
        found.second = std::min(found.second, distance);
      }
    }
  }
  return found;
}

}  // namespace froth
