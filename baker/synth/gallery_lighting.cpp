// A fixed lighting model in place of global illumination: the window as a soft area light, the sun through
// its panes, the glow of the sunlit floor, spots on the pictures, ambient light with occlusion; gloss mirrors
// a blurred sketch of the room.
#include <algorithm>
#include <cmath>

#include "baker/synth/gallery_scene.h"
#include "baker/synth/procedural_textures.h"
#include "shaders/foam/colour.h"

namespace froth {

using glm::dot;
using glm::dvec2;
using glm::dvec3;
using glm::mix;

namespace {

const dvec3 kToSun = glm::normalize(dvec3(-1.0, -0.34, 0.66));
constexpr dvec3 kSunLight{6.6, 5.3, 3.5};
constexpr dvec3 kSkyLight{2.9, 3.2, 3.6};
constexpr dvec3 kSpotLight{2.6, 2.1, 1.45};
constexpr dvec3 kSunPatch{2.75, 3.9, 0.02};  // middle of the sunlit floor
constexpr dvec3 kWindowMiddle{-kWallDepth, 0.5 * (kWindowLow.x + kWindowHigh.x), 0.5 * (kWindowLow.y + kWindowHigh.y)};

struct Spot {
  dvec3 position, target;
};
constexpr Spot kSpots[] = {{{2.1, 4.5, 3.2}, {2.1, 6.0, 1.8}}, {{4.15, 4.4, 3.2}, {4.15, 6.0, 1.85}},
                           {{6.2, 4.5, 3.2}, {6.2, 6.0, 1.8}}, {{6.4, 3.0, 3.2}, {8.0, 3.0, 1.85}},
                           {{2.7, 1.5, 3.2}, {2.7, 0.0, 1.8}}, {{5.2, 1.6, 3.2}, {5.2, 0.0, 1.85}}};

// Share of a window-plane point that is glass and not bar, blurred over `blur` [m].
double glazing(const dvec2& p, double blur) {
  const double rim = kWindowBar + 0.02;
  double share = smoothInterval(kWindowLow.x + rim, kWindowHigh.x - rim, blur, p.x) *
                 smoothInterval(kWindowLow.y + rim, kWindowHigh.y - rim, blur, p.y);
  const dvec2 pitch = (kWindowHigh - kWindowLow) / dvec2(4, 3);
  const dvec2 place = p - kWindowLow;
  // Wider blurs than the bars wash them out.
  const double bar = 0.5 * kWindowBar;
  const double depth = std::min(1.0, kWindowBar / blur);
  share *= 1 - depth * (1 - smoothRamp(bar - 0.5 * blur, bar + 0.5 * blur, distanceToMultiple(place.x, pitch.x)));
  share *= 1 - depth * (1 - smoothRamp(bar - 0.5 * blur, bar + 0.5 * blur, distanceToMultiple(place.y, pitch.y)));
  return share;
}

// Irradiance of the panes, a diffuse rectangle, by Lambert's contour integral, over pi. Light from below the
// horizon is cut as a whole, which is smooth enough for a window.
double windowFormFactor(const dvec3& x, const dvec3& normal) {
  constexpr double kNearest = 0.03;  // [m] the frame of the panes itself is in the dark
  if (x.x <= kNearest - kWallDepth) return 0;
  const dvec3 corners[4] = {{-kWallDepth, kWindowLow.x, kWindowLow.y},
                            {-kWallDepth, kWindowLow.x, kWindowHigh.y},
                            {-kWallDepth, kWindowHigh.x, kWindowHigh.y},
                            {-kWallDepth, kWindowHigh.x, kWindowLow.y}};
  dvec3 directions[4];
  for (int i = 0; i < 4; ++i) directions[i] = glm::normalize(corners[i] - x);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const dvec3 &a = directions[i], &b = directions[(i + 1) % 4];
    const dvec3 edge = glm::cross(a, b);
    const double sine = glm::length(edge);
    if (sine < 1e-9) continue;
    sum += std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * dot(normal, edge) / sine;
  }
  return std::max(sum, 0.0) / glm::two_pi<double>();
}

double ambientOcclusion(const dvec3& x, const dvec3& normal) {
  constexpr double kReaches[] = {0.05, 0.14, 0.36, 0.8};
  constexpr double kStrength = 0.19;
  double open = 1;
  for (const double reach : kReaches) {
    open -= kStrength * (1 - std::max(galleryScene().clearance(x + reach * normal, reach), 0.0) / reach);
  }
  return std::max(open, 0.0);
}

dvec3 sunIrradiance(const dvec3& x, const dvec3& normal) {
  const double facing = dot(normal, kToSun);
  if (facing <= 0 || x.x <= 0) return {};
  const double toWindow = (x.x + kWallDepth) / -kToSun.x;
  const dvec3 crossing = x + toWindow * kToSun;
  const double blur = 0.012 + 0.012 * toWindow;
  // The reveal's near rim narrows the beam as well.
  const dvec3 atWall = x + (x.x / -kToSun.x) * kToSun;
  const double share = glazing({crossing.y, crossing.z}, blur) *
                       smoothInterval(kWindowLow.x, kWindowHigh.x, blur, atWall.y) *
                       smoothInterval(kWindowLow.y, kWindowHigh.y, blur, atWall.z);
  if (share <= 0) return {};
  const double lit = galleryScene().softVisibility(x + 0.004 * normal, crossing, 0.012);
  return kSunLight * (share * facing * lit);
}

dvec3 spotIrradiance(const dvec3& x, const dvec3& normal) {
  dvec3 sum(0);
  for (const Spot& spot : kSpots) {
    const dvec3 toSpot = spot.position - x;
    const double squared = dot(toSpot, toSpot);
    const double facing = dot(normal, toSpot) / std::sqrt(squared);
    if (facing <= 0) continue;
    const double off = dot(-toSpot / std::sqrt(squared), glm::normalize(spot.target - spot.position));
    sum += kSpotLight * (facing * smoothRamp(0.80, 0.96, off) / (0.4 + 0.5 * squared));
  }
  return sum;
}

// Light that the sunlit floor throws back.
dvec3 bounceIrradiance(const dvec3& x, const dvec3& normal) {
  const dvec3 toPatch = kSunPatch - x;
  const double squared = dot(toPatch, toPatch) + 0.5;
  const double distance = std::sqrt(squared);
  const double facing = 0.3 + 0.7 * std::max(dot(normal, toPatch) / distance, 0.0);
  const double leaving = std::max(-toPatch.z / distance, 0.0);
  return dvec3(1.15, 0.85, 0.5) * (facing * leaving / squared);
}

dvec3 irradiance(const dvec3& x, const dvec3& normal) {
  const dvec3 below(0.21, 0.17, 0.13), above(0.235, 0.24, 0.25);
  const dvec3 ambient = mix(below, above, 0.5 + 0.5 * normal.z);
  const double occlusion = ambientOcclusion(x, normal);
  const double form = windowFormFactor(x, normal);
  const double lit =
      form > 1e-4 ? galleryScene().softVisibility(x + 0.01 * normal, kWindowMiddle + dvec3(0.05, 0, 0), 0.25) : 0.0;
  return occlusion * (ambient + bounceIrradiance(x, normal) + spotIrradiance(x, normal)) +
         (0.4 + 0.6 * occlusion) * lit * form * kSkyLight + sunIrradiance(x, normal);
}

// The room as a mirror of the given blur [radians] shows it: window, sunlit floor, lamps, and gradients for
// the rest.
dvec3 blurredRoom(const dvec3& x, const dvec3& direction, double blur) {
  const dvec3 floor(0.16, 0.12, 0.085), walls(0.16, 0.21, 0.21), ceiling(0.34, 0.33, 0.31);
  dvec3 light = mix(walls, ceiling, smoothRamp(0.15, 0.6 + blur, direction.z));
  light = mix(light, floor, smoothRamp(0.05, 0.4 + blur, -direction.z));
  if (direction.x < -0.02) {
    const double away = x.x / -direction.x;
    const dvec3 crossing = x + away * direction;
    const double share = glazing({crossing.y, crossing.z}, std::max(0.05, blur * away * 2));
    light = mix(light, mix(dvec3(0.9, 1.0, 0.95), dvec3(2.6, 2.8, 3.0), smoothRamp(-0.15, 0.25, direction.z)), share);
  }
  if (direction.z < -0.02 && x.z > 0.05) {
    const double away = x.z / -direction.z;
    const dvec2 gap = dvec2(x + away * direction - kSunPatch) / dvec2(1.3 + blur * away, 1.2 + blur * away);
    light += dvec3(0.75, 0.56, 0.34) * std::exp(-dot(gap, gap) * 1.5);
  }
  return light;
}

// A filmic curve (Narkowicz 2015), then the display's.
dvec3 displayFromRadiance(const dvec3& radiance) {
  const dvec3 x = radiance * 0.95;
  const dvec3 filmic = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
  const dvec3 clamped = glm::clamp(filmic, dvec3(0), dvec3(1));
  return {foam::displayFromLinear(clamped.x), foam::displayFromLinear(clamped.y), foam::displayFromLinear(clamped.z)};
}

}  // namespace

LitPoint lightPoint(const Solid& solid, const dvec3& x) {
  const SurfacePoint base = solid.shape->nearest(x);
  const Texel texel = solid.material.texture(base);
  LitPoint point{x, embossedNormal(solid, base), texel.emission, texel.reflectance, texel.roughness};
  if (texel.albedo != dvec3(0)) point.radiance += texel.albedo * irradiance(x, point.normal);
  return point;
}

dvec3 displayColour(const LitPoint& point, const dvec3& direction) {
  if (point.reflectance == dvec3(0)) return displayFromRadiance(point.radiance);
  const double facing = std::max(-dot(point.normal, direction), 0.0);
  const double grazing = std::pow(1 - facing, 4);
  // A rough surface never becomes a full mirror at grazing angles.
  const dvec3 fresnel = point.reflectance + (1 - 2 * point.roughness) * 0.4 * grazing * (dvec3(1) - point.reflectance);
  const dvec3 mirrored = glm::reflect(direction, point.normal);
  return displayFromRadiance(point.radiance + fresnel * blurredRoom(point.position, mirrored, point.roughness));
}

}  // namespace froth
