// The random numbers of a start.
#pragma once

#include "base/counter_random.h"

namespace froth {

enum class StartStream : uint64_t { kPriority, kMixture, kPixel, kDepth, kNormal, kDetailSites, kAxes, kMatchPixel };

inline CounterRandom startRandom(uint64_t seed, StartStream stream) {
  return CounterRandom(seed, Purpose::kStart, static_cast<uint64_t>(stream));
}

// Normal with mean 0 and deviation 1 (Box & Muller 1958).
inline double normalAt(const CounterRandom& random, uint64_t index) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform(2 * index)));
  return radius * std::cos(glm::two_pi<double>() * random.uniform(2 * index + 1));
}

}  // namespace froth
