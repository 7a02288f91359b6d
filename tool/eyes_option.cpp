#include "tool/eyes_option.h"

#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "format/limits.h"

namespace froth {
namespace {

constexpr std::string_view kCameras = "cameras", kDistance = "cameras+", kBox = "box:";

// Numbers with commas between them, each within +-2^50; none if one is not.
std::vector<double> parseNumbers(std::string_view text) {
  std::vector<double> numbers;
  const char* const end = text.data() + text.size();
  for (const char* next = text.data();; ++next) {
    double value = 0;
    const auto [rest, error] = std::from_chars(next, end, value);
    if (error != std::errc{} || !(value >= -kMaxNumber && value <= kMaxNumber)) return {};
    numbers.push_back(value);
    if (rest == end) return numbers;
    if (*rest != ',') return {};
    next = rest;
  }
}

std::optional<EyeChoice> parseDistance(std::string_view text) {
  const std::vector<double> numbers = parseNumbers(text);
  if (numbers.size() != 1 || !(numbers[0] > 0)) return {};
  return EyeChoice{.aroundCameras = numbers[0], .box = {}};
}

std::optional<EyeChoice> parseBox(std::string_view text) {
  const std::vector<double> numbers = parseNumbers(text);
  if (numbers.size() != 6) return {};
  Box box;
  for (size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = numbers[axis];
    box.max[axis] = numbers[axis + 3];
    if (box.min[axis] > box.max[axis]) return {};
  }
  return EyeChoice{.aroundCameras = 0, .box = box};
}

}  // namespace

Result<EyeChoice> parseEyes(const std::string& text) {
  const std::string_view view = text;
  std::optional<EyeChoice> eyes;
  if (view == kCameras) eyes = EyeChoice{};
  if (view.starts_with(kDistance)) eyes = parseDistance(view.substr(kDistance.size()));
  if (view.starts_with(kBox)) eyes = parseBox(view.substr(kBox.size()));
  if (eyes) return *eyes;
  return makeError(ErrorKind::kUsage,
                   "found '%.80s'; give cameras, cameras+0.5 (all eyes within 0.5 scene units of a camera), or "
                   "box:X0,Y0,Z0,X1,Y1,Z1 with the lower corner first",
                   printable(text).c_str());
}

}  // namespace froth
