#include "baker/tool/option_checks.h"

#include <charconv>
#include <string>

#include <fmt/format.h>

namespace froth {
namespace {

template <class Number>
CLI::Validator valuesBetween(const char* kind, Number least, Number most) {
  const auto check = [=](const std::string& text) -> std::string {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const bool isNumber = error == std::errc{} && rest == end;
    if (isNumber && value >= least && value <= most) return {};  // false for nan
    return fmt::format("found '{}'; give a {}number from {} to {}", text, kind, least, most);
  };
  return {check, ""};
}

}  // namespace

CLI::Validator numberBetween(double least, double most) {
  return valuesBetween("", least, most);
}

CLI::Validator countBetween(uint64_t least, uint64_t most) {
  return valuesBetween("whole ", least, most);
}

}  // namespace froth
