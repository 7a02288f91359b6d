#include "base/image/mean_square.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace froth {

double meanSquare(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.values.size(); ++i) {
    const double difference = double{std::clamp(a.values[i], 0.0f, 1.0f)} - std::clamp(b.values[i], 0.0f, 1.0f);
    sum += difference * difference;
  }
  return sum / static_cast<double>(a.values.size());
}

double decibels(double meanSquare) {
  return meanSquare == 0 ? std::numeric_limits<double>::infinity() : -10 * std::log10(meanSquare);
}

}  // namespace froth
