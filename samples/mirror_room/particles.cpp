#include "samples/mirror_room/particles.h"

#include <cmath>
#include <numbers>

namespace froth {
namespace {

constexpr int kCount = 18;
constexpr double kTurnsPerSecond = 0.08, kRisesPerSecond = 0.05;

// Spreads 0, 1, 2 ... evenly over 0..1, with `start` to begin with.
double spread(int i, double step, double start) {
  const double value = i * step + start;
  return value - std::floor(value);
}

}  // namespace

std::vector<Particle> particlesAt(const Room& room, double seconds) {
  std::vector<Particle> particles;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * std::numbers::pi * spread(i, 0.618034, kTurnsPerSecond * seconds);
    const double out = 0.15 + 0.5 * spread(i, 0.754878, 0);
    const double up = spread(i, 0.569840, kRisesPerSecond * seconds);
    const double size = room.centre.scale;
    const glm::dvec3 offset(out * std::cos(angle), 0.1 + 0.9 * up, out * std::sin(angle));
    // They are born and fade at the ends of their way.
    const double life = std::sin(std::numbers::pi * up);
    const glm::vec3 glow = i % 2 ? glm::vec3(1.3f, 0.75f, 0.25f) : glm::vec3(0.3f, 0.8f, 1.3f);
    particles.push_back({room.centre.position + size * offset, 0.03 * size, glm::vec4(glow, 0.75 * life)});
  }
  return particles;
}

}  // namespace froth
