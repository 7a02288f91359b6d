// Figures of a report as text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace froth {

// 3 digits that count: "0.0123", "4.56e-07", "1234".
std::string shortNumber(double value);
std::string decibels(double value);
std::string percent(double share);
std::string countText(double count);                 // "499 712"
std::string signedText(double value, int decimals);  // "+1.20", "−0.31", "0.00"

bool holds(const std::vector<std::string>& texts, const std::string& text);

// The unit for figures up to `largest` bytes.
struct ByteUnit {
  const char* name;
  double bytes;
};
ByteUnit unitOfBytes(double largest);
std::string bytesText(double bytes);  // "12.3 MB", of 10^6

}  // namespace froth
