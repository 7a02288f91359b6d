// Tone curves that engines end a frame with, and the other way: the scene-linear light that a curve turns into a given
// colour of the display, which is linear too (the display's own coding comes after it).
//
// Sources. Reinhard et al., "Photographic tone reproduction for digital images", 2002, equation 3, per channel:
// x / (1 + x). Narkowicz, "ACES filmic tone mapping curve", 2015, per channel:
// x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14). Khronos PBR Neutral, 2024, which keeps hues: colours below 0.8
// but for an offset that takes Fresnel's 4 % away.
#ifndef FROTH_FOAM_TONE_H
#define FROTH_FOAM_TONE_H
#include "prelude.h"

const int kToneNone = 0;
const int kToneReinhard = 1;
const int kToneAcesNarkowicz = 2;
const int kToneKhronosNeutral = 3;

// Some curves reach white only at infinite light. This is as white as 8 bits can tell, and finite: at most 255 of
// light.
FOAM_FN real whitestDisplay(real) { return real(255.0 / 256.0); }

FOAM_FN real sceneFromReinhard(real value) { return value / (real(1) - value); }

FOAM_FN real sceneFromAcesNarkowicz(real value) {
  real square = real(2.51) - real(2.43) * value;
  real halfLinear = real(0.5) * (real(0.59) * value - real(0.03));
  return (halfLinear + sqrt(halfLinear * halfLinear + real(0.14) * square * value)) / square;
}

FOAM_FN real3 sceneFromKhronosNeutral(real3 colour) {
  real start = real(0.76);  // of compression: 0.8 - 0.04
  real desaturation = real(0.15);
  real peak = max(colour.x, max(colour.y, colour.z));
  if (peak > start) {
    real room = real(1) - start;
    real oldPeak = room * room / (real(1) - peak) - room + start;
    real washed = desaturation * (oldPeak - peak) + real(1);
    colour = (colour * washed + (real(1) - washed) * real3(peak)) * (oldPeak / peak);
  }
  // below it lie colours brighter and purer than the curve has
  real least = max(min(colour.x, min(colour.y, colour.z)), real(0));
  real offset = least < real(0.04) ? sqrt(least / real(6.25)) - least : real(0.04);
  return real3(max(colour.x, real(0)), max(colour.y, real(0)), max(colour.z, real(0))) + real3(offset);
}

// Of a colour of linear display light; beyond 0 to 1 it is clamped.
FOAM_FN real3 sceneFromDisplay(int curve, real3 display) {
  real whitest = whitestDisplay(display.x);
  real3 colour = real3(min(max(display.x, real(0)), whitest), min(max(display.y, real(0)), whitest),
                       min(max(display.z, real(0)), whitest));
  if (curve == kToneReinhard) {
    return real3(sceneFromReinhard(colour.x), sceneFromReinhard(colour.y), sceneFromReinhard(colour.z));
  }
  if (curve == kToneAcesNarkowicz) {
    return real3(sceneFromAcesNarkowicz(colour.x), sceneFromAcesNarkowicz(colour.y), sceneFromAcesNarkowicz(colour.z));
  }
  return curve == kToneKhronosNeutral ? sceneFromKhronosNeutral(colour) : display;
}

#include "postlude.h"
#endif
