// The pictures on the gallery's walls.
#include <cmath>

#include "baker/synth/gallery_materials.h"
#include "baker/synth/procedural_textures.h"

namespace froth {

using glm::dvec2;
using glm::dvec3;
using glm::mix;

namespace {

constexpr double kFrame = 0.085;      // [m] width of the frame
constexpr double kFrameRise = 0.010;  // [m] its moulding above the canvas
constexpr dvec3 kGold{0.55, 0.36, 0.12};

// Canvases: x in [-1, 1] times the aspect, y in [-1, 1], up.
dvec3 paintBubbles(const dvec2& x) {
  const Bubbles bubbles = findBubbles(x * 2.4 + 3.0, 101);
  const dvec3 warm = mix(dvec3(0.80, 0.32, 0.06), dvec3(0.86, 0.70, 0.30), bubbles.hash * 2 - 1);
  const dvec3 cool = mix(dvec3(0.03, 0.16, 0.30), dvec3(0.10, 0.45, 0.45), bubbles.hash * 2);
  const dvec3 film = bubbles.hash > 0.5 ? warm : cool;
  const double rim = smoothRamp(0.03, 0.13, bubbles.second - bubbles.nearest);
  const double shine = std::exp(-10 * bubbles.nearest);
  return mix(dvec3(0.02, 0.02, 0.03), mix(film, dvec3(0.95), 0.4 * shine), rim);
}

dvec3 paintSunset(const dvec2& x) {
  const double sun = glm::length(x - dvec2(0.35, 0.12));
  dvec3 colour = mix(dvec3(0.85, 0.36, 0.08), dvec3(0.10, 0.08, 0.28), smoothRamp(-0.2, 1.0, x.y));
  colour = mix(colour, dvec3(0.92, 0.55, 0.35), 0.6 * smoothRamp(0.0, 0.8, fractalNoise({x.x * 1.2, x.y * 5}, 3, 111)));
  colour = mix(colour, dvec3(1.0, 0.83, 0.38), 1 - smoothRamp(0.22, 0.26, sun));
  const double glitter = 0.5 + 0.5 * std::sin(26 * x.y + 3 * gradientNoise(x * dvec2(2, 9), 113));
  const double path = std::exp(-9 * (x.x - 0.35) * (x.x - 0.35));
  const dvec3 sea = mix(dvec3(0.05, 0.06, 0.17), dvec3(0.95, 0.55, 0.18), glitter * (0.15 + 0.75 * path));
  colour = mix(colour, sea, smoothRamp(-0.01, 0.01, -0.10 - x.y));
  const double cliff = -0.25 + 0.35 * fractalNoise({x.x * 2.0, 4.0}, 3, 117) - 0.9 * smoothRamp(-1.0, -0.1, x.x);
  return mix(colour, dvec3(0.03, 0.02, 0.05), smoothRamp(-0.02, 0.02, cliff + 0.55 - x.y));
}

dvec3 paintCircles(const dvec2& x) {
  static constexpr dvec3 kPalette[] = {{0.75, 0.10, 0.06}, {0.90, 0.62, 0.10}, {0.04, 0.22, 0.42},
                                       {0.82, 0.78, 0.66}, {0.06, 0.32, 0.22}, {0.50, 0.12, 0.28}};
  const dvec2 grid = x * 1.5 + 0.25;
  const auto i = static_cast<int64_t>(std::floor(grid.x)), j = static_cast<int64_t>(std::floor(grid.y));
  const double radius = glm::length(grid - glm::floor(grid) - 0.5);
  const auto pick = [&](uint32_t ring) { return kPalette[static_cast<size_t>(latticeHash(i, j, 120 + ring) * 6)]; };
  dvec3 colour = pick(0);
  for (uint32_t ring = 1; ring <= 3; ++ring) {
    const double edge = 0.47 - 0.13 * (ring - 1) - 0.02 * latticeHash(i, j, 130 + ring);
    colour = mix(colour, pick(ring), smoothRamp(-0.02, 0.02, edge - radius));
  }
  return colour;
}

dvec3 paintWeave(const dvec2& x) {
  const dvec2 p = x * 3.0;
  const double over = std::sin(glm::pi<double>() * p.x) * std::sin(glm::pi<double>() * p.y);
  const double across = smoothInterval(0.12, 0.88, 0.1, p.x - std::floor(p.x));
  const double along = smoothInterval(0.12, 0.88, 0.1, p.y - std::floor(p.y));
  const dvec3 red = mix(dvec3(0.04), dvec3(0.62, 0.11, 0.09), across);
  const dvec3 sand = mix(dvec3(0.04), dvec3(0.80, 0.66, 0.42), along);
  return mix(red, sand, smoothRamp(-0.08, 0.08, over)) * (0.85 + 0.15 * std::abs(over));
}

dvec3 paintMarbling(const dvec2& x) {
  const dvec2 warp(fractalNoise(x * 0.9, 3, 141), fractalNoise(x * 0.9 + 5.0, 3, 145));
  const double phase = 7 * fractalNoise(x * 0.7 + 1.3 * warp, 2, 149);
  const dvec3 colour = 0.5 + 0.5 * glm::cos(phase + dvec3(0.2, 1.1, 2.2));
  return mix(dvec3(0.05, 0.08, 0.16), dvec3(0.90, 0.84, 0.70), colour);
}

dvec3 paint(Painting painting, const dvec2& x) {
  switch (painting) {
    case Painting::kBubbles:
      return paintBubbles(x);
    case Painting::kSunset:
      return paintSunset(x);
    case Painting::kCircles:
      return paintCircles(x);
    case Painting::kWeave:
      return paintWeave(x);
    case Painting::kMarbling:
      return paintMarbling(x);
  }
  return {};
}

}  // namespace

Material pictureMaterial(Painting painting, const dvec2& halfExtent, uint32_t wallAxis) {
  const uint32_t horizontal = 1 - wallAxis;
  // Distance inwards from the picture's rim.
  const auto inset = [=](const SurfacePoint& point) {
    return std::min(halfExtent.x - std::abs(point.local[static_cast<int>(horizontal)]),
                    halfExtent.y - std::abs(point.local.z));
  };
  const auto onFront = [=](const SurfacePoint& point) { return point.face / 2 == wallAxis; };
  const auto texture = [=](const SurfacePoint& point) {
    Texel texel;
    const double canvas = onFront(point) ? smoothRamp(kFrame - 0.006, kFrame + 0.006, inset(point)) : 0.0;
    const double scale = halfExtent.y - kFrame;
    const dvec2 x(point.local[static_cast<int>(horizontal)] / scale, point.local.z / scale);
    texel.albedo = mix(kGold, paint(painting, x) * 0.9, canvas);
    texel.reflectance = kGold * 0.45 * (1 - canvas);
    texel.roughness = 0.35;
    return texel;
  };
  const auto relief = [=](const SurfacePoint& point) {
    if (!onFront(point)) return 0.0;
    const double at = inset(point);
    return kFrameRise * (smoothRamp(0.0, 0.03, at) - 1.6 * smoothRamp(kFrame - 0.035, kFrame, at));
  };
  return {texture, relief, kFrameRise};
}

}  // namespace froth
