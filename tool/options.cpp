#include "tool/options.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "baker/input/foam_input.h"
#include "host/method.h"

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

constexpr std::pair<std::string_view, double> kUnits[] = {{"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}};

// Seconds.
std::optional<double> parseDuration(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  for (const auto& [unit, seconds] : kUnits) {
    if (std::string_view(rest, end) == unit) return value * seconds;
  }
  return std::nullopt;
}

// In the largest unit that leaves a number of at least one.
std::string durationText(double seconds) {
  const auto* unit = std::end(kUnits) - 1;
  while (unit > kUnits && seconds < unit->second) --unit;
  return seconds == 0 ? "0s" : fmt::format("{:g}{}", seconds / unit->second, unit->first);
}

}  // namespace

CLI::Validator numberBetween(double least, double most) { return valuesBetween("", least, most); }

CLI::Validator countBetween(uint64_t least, uint64_t most) { return valuesBetween("whole ", least, most); }

CLI::Option* addDurationOption(CLI::App& command, const std::string& name, double& seconds,
                               const std::string& description, double least, double most) {
  const auto check = [=](const std::string& text) -> std::string {
    const std::optional<double> value = parseDuration(text);
    if (value && *value >= least && *value <= most) return {};
    return fmt::format("found '{}'; give a duration from {} to {}, as 500ms, 90s, 5min or 1h", text,
                       durationText(least), durationText(most));
  };
  const auto keep = [&seconds](const std::string& text) { seconds = *parseDuration(text); };
  return command.add_option_function<std::string>(name, keep, description)
      ->type_name("DURATION")
      ->default_str(durationText(seconds))
      ->check(CLI::Validator(check, ""));
}

std::vector<std::string> methodNames(std::vector<std::string> others) {
  for (const MethodInfo& info : kMethods) others.emplace_back(info.name);
  return others;
}

void addViewOptions(CLI::App& command, ViewOptions& options) {
  command.add_option("--view", options.view, "Index of one view, from 0; without it all of them")
      ->type_name("I")
      ->check(countBetween(0, std::numeric_limits<uint32_t>::max()));
  command.add_option("--size", options.size, "Size of the images instead of the view's own")
      ->type_name("WxH")
      ->check(CLI::Validator(checkSize, ""));
}

void addLayersOption(CLI::App& command, uint32_t& layers) {
  command.add_option("--layers", layers, "Of an asset: 1 one colour per cell, 2 detail, 3 view dependence too")
      ->capture_default_str()
      ->check(countBetween(1, kAllLayers));
}

// A flag with an optional value, so that it never swallows the argument after it.
void addFiguresOption(CLI::App& command, FiguresOutput& output) {
  command.add_flag("--json{-}", output.target, "Figures as JSON on stdout, or to a file with --json=FILE");
}

}  // namespace froth
