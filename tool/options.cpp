#include "tool/options.h"

#include <charconv>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "baker/input/foam_input.h"

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
