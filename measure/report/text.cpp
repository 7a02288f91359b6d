#include "measure/report/text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace froth {

bool holds(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

std::string shortNumber(double value) {
  if (std::isnan(value)) return "not a number";
  const double size = std::abs(value);
  const std::string sign = value < 0 ? "−" : "";
  if (std::isinf(size)) return sign + "∞";
  if (size == 0) return "0";
  if (size < 0.9995e-3 || size >= 1e6) {
    const std::string text = fmt::format("{:.2e}", size);
    const size_t e = text.find('e');
    return fmt::format("{}{}e{}", sign, text.substr(0, e), std::stoi(text.substr(e + 1)));
  }
  // The third digit that counts; 9.996 is 10.0.
  const int decimals = std::max(0, 2 - int(std::floor(std::log10(size * 1.0005))));
  return fmt::format("{}{:.{}f}", sign, size, decimals);
}

std::string decibels(double value) { return std::isfinite(value) ? fmt::format("{:.2f}", value) : shortNumber(value); }

std::string percent(double share) { return shortNumber(share * 100) + " %"; }

std::string countText(double count) {
  std::string text = fmt::format("{:.0f}", count);
  for (size_t at = text.size(); at > 3;) text.insert(at -= 3, "\u202f");  // a narrow space that does not break
  return text;
}

std::string signedText(double value, int decimals) {
  const std::string size = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool isZero = size.find_first_not_of("0.") == std::string::npos;
  return (isZero ? "" : value < 0 ? "−" : "+") + size;
}

ByteUnit unitOfBytes(double largest) {
  if (largest >= 1e9) return {"GB", 1e9};
  if (largest >= 1e6) return {"MB", 1e6};
  if (largest >= 1e3) return {"kB", 1e3};
  return {"B", 1};
}

std::string bytesText(double bytes) {
  const ByteUnit unit = unitOfBytes(std::abs(bytes));
  return unit.bytes == 1 ? fmt::format("{:.0f} B", bytes) : shortNumber(bytes / unit.bytes) + " " + unit.name;
}

}  // namespace froth
