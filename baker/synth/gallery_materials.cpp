#include "baker/synth/gallery_materials.h"

#include <cmath>

#include "baker/synth/gallery_scene.h"
#include "baker/synth/procedural_textures.h"

namespace froth {

using glm::dvec2;
using glm::dvec3;
using glm::mix;

namespace {

constexpr double kTile = 0.5;           // [m] floor tiles, turned by 45 degrees
constexpr double kJoint = 0.010;        // [m] half-width of a joint
constexpr double kJointDepth = 0.0025;  // [m]
constexpr double kPanellingTop = 0.95;
constexpr double kRailTop = 1.03;

dvec2 tilePlane(const dvec3& x) { return dvec2(x.x + x.y, x.x - x.y) * (std::sqrt(0.5) / kTile); }

// Distance to the nearest joint between floor tiles [m].
double jointDistance(const dvec3& x) {
  const dvec2 p = tilePlane(x);
  return kTile * std::min(distanceToMultiple(p.x, 1.0), distanceToMultiple(p.y, 1.0));
}

double marbleVeins(const dvec2& x, double sharpness, uint32_t seed) {
  const dvec2 warp(fractalNoise(x * 1.3, 2, seed), fractalNoise(x * 1.3 + 7.7, 2, seed + 9));
  return std::exp(-sharpness * std::abs(fractalNoise(x + 0.8 * warp, 3, seed + 20)));
}

// Horizontal place along a wall, and height [m].
dvec2 wallPlane(const SurfacePoint& point) {
  return {point.face < 2 ? point.position.y : point.position.x, point.position.z};
}

// Distance inwards from the rim of the nearest panel of the panelling [m]; negative on the stiles between.
double panelInset(const dvec2& x) {
  constexpr double kPitch = 0.8, kStile = 0.09, kLow = 0.2, kHigh = 0.83;
  const double side = distanceToMultiple(x.x, kPitch) - kStile;
  return std::min({side, x.y - kLow, kHigh - x.y});
}

// The embossed ornament of the plaster: four-leaved flowers in staggered rows [0..1].
double ornament(const dvec2& x) {
  const double u = x.x / 0.5, v = x.y / 0.5;
  const double row = std::floor(v);
  const dvec2 p(u + 0.5 * row - std::floor(u + 0.5 * row) - 0.5, v - row - 0.5);
  const double radius = glm::length(p), angle = std::atan2(p.y, p.x);
  const double flower = smoothRamp(-0.035, 0.035, 0.19 + 0.13 * std::cos(4 * angle) - radius);
  const double heart = smoothRamp(-0.03, 0.03, 0.07 - radius);
  return std::max(flower - heart, 0.0);
}

double wallRelief(const SurfacePoint& point) {
  if (point.face >= 4) return 0;
  const dvec2 x = wallPlane(point);
  if (x.y < kPanellingTop) {
    const double inset = panelInset(x);
    return -0.012 * smoothRamp(-0.01, 0.012, inset) + 0.016 * smoothRamp(0.03, 0.085, inset);
  }
  const double rail = smoothInterval(kPanellingTop, kRailTop, 0.03, x.y);
  return 0.016 * rail + 0.006 * (1 - rail) * ornament(x) * smoothRamp(kRailTop + 0.03, kRailTop + 0.12, x.y);
}

Texel wallTexture(const SurfacePoint& point) {
  const dvec2 x = wallPlane(point);
  Texel texel;
  const double wear = 1 + 0.05 * fractalNoise(x * 2.5, 3, 5);
  if (x.y < kRailTop) {
    texel.albedo = dvec3(0.70, 0.67, 0.60) * wear;
    texel.reflectance = dvec3(0.03);
    texel.roughness = 0.5;
    return texel;
  }
  texel.albedo = mix(dvec3(0.085, 0.21, 0.215), dvec3(0.17, 0.30, 0.27), ornament(x)) * wear;
  return texel;
}

Texel floorTexture(const SurfacePoint& point) {
  const dvec3& x = point.position;
  const dvec2 p = tilePlane(x);
  const auto i = static_cast<int64_t>(std::floor(p.x)), j = static_cast<int64_t>(std::floor(p.y));
  const dvec2 place = dvec2(x) * 2.2 + 13.0 * dvec2(latticeHash(i, j, 1), latticeHash(i, j, 2));
  const double edge = std::min({x.x, x.y, kRoomSize.x - x.x, kRoomSize.y - x.y});
  Texel texel;
  const dvec3 cream = mix(dvec3(0.60, 0.52, 0.40), dvec3(0.38, 0.27, 0.17), 0.8 * marbleVeins(place, 7, 31));
  const dvec3 slate = mix(dvec3(0.075, 0.10, 0.105), dvec3(0.34, 0.37, 0.35), 0.7 * marbleVeins(place, 9, 41));
  texel.albedo = ((i + j) % 2 == 0 ? cream : slate) * (0.88 + 0.24 * latticeHash(i, j, 3));
  const double border = smoothInterval(0.34, 0.46, 0.02, edge);
  texel.albedo = mix(texel.albedo, dvec3(0.26, 0.09, 0.05), border);
  const double joint = (1 - border) * (1 - smoothRamp(kJoint, kJoint + 0.014, jointDistance(x)));
  texel.albedo = mix(texel.albedo, dvec3(0.16, 0.14, 0.12), joint);
  texel.reflectance = dvec3(0.05) * (1 - 0.7 * joint);
  texel.roughness = 0.2;
  return texel;
}

double floorRelief(const SurfacePoint& point) {
  return kJointDepth * (smoothRamp(0.2 * kJoint, kJoint + 0.018, jointDistance(point.position)) - 1);
}

// Distance to the nearest beam between the coffers of the ceiling [m], negative on the beam.
double cofferInset(const dvec3& x) {
  return std::min(distanceToMultiple(x.x, 1.0), distanceToMultiple(x.y, 1.0)) - 0.11;
}

// Mountains behind a lake behind a meadow, as seen at azimuth and elevation [radians].
dvec3 landscape(double azimuth, double elevation) {
  constexpr double kEdge = 0.005;  // softness of silhouettes
  const auto below = [&](double crest) { return smoothRamp(-kEdge, kEdge, crest - elevation); };
  const auto ridge = [&](double frequency, uint32_t seed) { return fractalNoise({azimuth * frequency, 0.5}, 4, seed); };

  const double cover = fractalNoise(dvec2(azimuth * 3.5, elevation * 11.0), 4, 70);
  dvec3 colour = mix(dvec3(0.80, 0.70, 0.56), dvec3(0.10, 0.27, 0.60), smoothRamp(-0.02, 0.30, elevation));
  colour =
      mix(colour, dvec3(1.05, 0.98, 0.90), 0.9 * smoothRamp(-0.05, 0.35, cover) * smoothRamp(0.05, 0.14, elevation));

  const double peaks = 0.085 + 0.06 * ridge(3.0, 80);
  const double snow = smoothRamp(-0.012, 0.012, elevation - peaks + 0.03 - 0.02 * ridge(17.0, 81));
  const double crags = fractalNoise(dvec2(azimuth * 26.0 + elevation * 14.0, elevation * 20.0), 2, 82);
  colour = mix(colour, mix(dvec3(0.20, 0.26, 0.38) * (1 + 0.35 * crags), dvec3(0.82, 0.84, 0.88), snow), below(peaks));
  colour = mix(colour, dvec3(0.10, 0.19, 0.16), below(0.022 + 0.035 * ridge(4.5, 84)));

  const double ripples = 0.5 + 0.5 * gradientNoise({azimuth * 6.0, elevation * 60.0}, 97);
  colour = mix(colour, mix(dvec3(0.10, 0.23, 0.36), dvec3(0.48, 0.56, 0.58), ripples), below(-0.012));

  const double meadow = 0.5 + 0.5 * fractalNoise(dvec2(azimuth * 10.0, elevation * 30.0), 3, 90);
  const double shore = -0.075 + 0.03 * ridge(2.5, 95);
  colour = mix(colour, mix(dvec3(0.10, 0.20, 0.04), dvec3(0.36, 0.40, 0.10), meadow), below(shore));
  const double trees = shore - 0.01 + 0.09 * smoothRamp(0.1, 0.5, ridge(5.0, 96)) * (0.75 + 0.4 * ridge(40.0, 98));
  const double onShore = smoothRamp(-0.012, 0.0, elevation - shore + 0.012);
  return mix(colour, dvec3(0.035, 0.085, 0.03) * (1 + 0.8 * crags), below(trees) * onShore);
}

}  // namespace

Material floorMaterial() { return {floorTexture, floorRelief, kJointDepth}; }

Material wallMaterial() { return {wallTexture, wallRelief, 0.017}; }

Material ceilingMaterial() {
  const auto texture = [](const SurfacePoint& point) {
    Texel texel;
    const double inside = smoothRamp(0.0, 0.03, cofferInset(point.position));
    texel.albedo = mix(dvec3(0.74, 0.72, 0.68), dvec3(0.62, 0.60, 0.55), inside);
    return texel;
  };
  const auto relief = [](const SurfacePoint& point) {
    return 0.03 * (1 - smoothRamp(-0.01, 0.15, cofferInset(point.position)));
  };
  return {texture, relief, 0.03};
}

Material landscapeMaterial() {
  const auto texture = [](const SurfacePoint& point) {
    const dvec3 outwards = -point.normal;
    Texel texel;
    texel.albedo = dvec3(0);
    texel.emission = landscape(std::atan2(outwards.y, -outwards.x), std::asin(outwards.z));
    return texel;
  };
  return {texture, {}, 0};
}

Material marbleMaterial(const dvec3& tint) {
  const auto texture = [tint](const SurfacePoint& point) {
    const dvec3& x = point.position;
    const double veins = marbleVeins(dvec2(x.x + 0.6 * x.y, x.z - 0.5 * x.y) * 3.0, 6, 51);
    Texel texel;
    texel.albedo = tint * mix(dvec3(0.80), dvec3(0.33, 0.34, 0.36), 0.75 * veins);
    texel.reflectance = dvec3(0.035);
    texel.roughness = 0.3;
    return texel;
  };
  return {texture, {}, 0};
}

Material woodMaterial() {
  const auto texture = [](const SurfacePoint& point) {
    const dvec3& x = point.local;
    const double rings = std::sin(30 * (x.y + 0.06 * fractalNoise({x.x * 1.5, x.y * 4.0}, 2, 61)) + 4 * x.x);
    Texel texel;
    texel.albedo = mix(dvec3(0.33, 0.17, 0.075), dvec3(0.20, 0.09, 0.035), 0.5 + 0.5 * rings);
    texel.reflectance = dvec3(0.04);
    texel.roughness = 0.35;
    return texel;
  };
  return {texture, {}, 0};
}

Material columnMaterial(double radius) {
  const auto texture = [](const SurfacePoint& point) {
    Texel texel;
    texel.albedo = dvec3(0.66, 0.60, 0.50) * (1 + 0.07 * fractalNoise({point.local.z * 4, point.local.x * 9}, 2, 55));
    return texel;
  };
  const auto relief = [radius](const SurfacePoint& point) {
    constexpr double kFlutes = 12;
    const double angle = std::atan2(point.local.y, point.local.x);
    const double shaft = smoothRamp(0.18, 0.26, point.local.z) * (1 - smoothRamp(2.95, 3.05, point.local.z));
    return 0.05 * radius * shaft * (std::cos(kFlutes * angle) - 1);
  };
  return {texture, relief, 0.1 * radius};
}

Material plainMaterial(const dvec3& albedo) {
  const auto texture = [albedo](const SurfacePoint&) {
    Texel texel;
    texel.albedo = albedo;
    return texel;
  };
  return {texture, {}, 0};
}

Material lacquerMaterial(const dvec3& albedo, double roughness) {
  const auto texture = [albedo, roughness](const SurfacePoint&) {
    return Texel{albedo, dvec3(0.05), roughness, dvec3(0)};
  };
  return {texture, {}, 0};
}

Material metalMaterial(const dvec3& reflectance, double roughness) {
  const auto texture = [reflectance, roughness](const SurfacePoint&) {
    return Texel{0.15 * reflectance, reflectance, roughness, dvec3(0)};
  };
  return {texture, {}, 0};
}

Material bandedCeramicMaterial(double radius) {
  const auto texture = [radius](const SurfacePoint& point) {
    const dvec3 x = point.local / radius;
    const double angle = std::atan2(x.y, x.x);
    const double wave = x.z + 0.06 * std::sin(8 * angle);
    const double band = smoothInterval(-0.14, 0.14, 0.05, wave) - smoothInterval(-0.06, 0.06, 0.05, x.z);
    const double cap = smoothInterval(0.52, 0.62, 0.05, std::abs(x.z));
    Texel texel;
    texel.albedo = mix(dvec3(0.012, 0.045, 0.28), dvec3(0.75, 0.52, 0.14), std::max(band, cap));
    texel.reflectance = dvec3(0.06);
    texel.roughness = 0.18;
    return texel;
  };
  return {texture, {}, 0};
}

Material spiralBallMaterial(double radius) {
  const auto texture = [radius](const SurfacePoint& point) {
    const dvec3 x = point.local / radius;
    const double turn = 6 * std::atan2(x.y, x.x) + 5.0 * x.z;
    const double stripe = smoothRamp(-0.12, 0.12, std::sin(turn));
    const double cap = smoothRamp(0.86, 0.88, std::abs(x.z));
    Texel texel;
    texel.albedo = mix(mix(dvec3(0.78, 0.74, 0.66), dvec3(0.72, 0.20, 0.045), stripe), dvec3(0.06, 0.20, 0.22), cap);
    texel.reflectance = dvec3(0.045);
    texel.roughness = 0.25;
    return texel;
  };
  return {texture, {}, 0};
}

}  // namespace froth
