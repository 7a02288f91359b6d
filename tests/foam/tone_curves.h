// Tone curves as they were published, from scene-linear to linear display light.
#pragma once

#include <algorithm>

#include <glm/glm.hpp>

namespace froth {

inline double reinhard(double x) { return x / (1 + x); }

inline double acesNarkowicz(double x) {
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// github.com/KhronosGroup/ToneMapping, PBR_Neutral.
inline glm::dvec3 khronosNeutral(glm::dvec3 colour) {
  const double start = 0.8 - 0.04, desaturation = 0.15;
  const double least = std::min({colour.x, colour.y, colour.z});
  colour -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  const double peak = std::max({colour.x, colour.y, colour.z});
  if (peak < start) return colour;
  const double room = 1 - start, newPeak = 1 - room * room / (peak + room - start);
  colour *= newPeak / peak;
  const double grey = 1 - 1 / (desaturation * (peak - newPeak) + 1);
  return glm::mix(colour, glm::dvec3(newPeak), grey);
}

// By FrothToneCurve, which are the numbers of shaders/foam/tone.h.
inline glm::dvec3 applyToneCurve(int curve, const glm::dvec3& colour) {
  switch (curve) {
    case 1:
      return {reinhard(colour.x), reinhard(colour.y), reinhard(colour.z)};
    case 2:
      return {acesNarkowicz(colour.x), acesNarkowicz(colour.y), acesNarkowicz(colour.z)};
    case 3:
      return khronosNeutral(colour);
    default:
      return colour;
  }
}

}  // namespace froth
