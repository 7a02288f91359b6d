// Words of a line of text: what stands between spaces, tabs and returns.
#pragma once

#include <string_view>

namespace froth {

inline constexpr std::string_view kWordSpaces = " \t\r";

// The text without spaces at its ends.
inline std::string_view trimSpaces(std::string_view text) {
  const size_t first = text.find_first_not_of(kWordSpaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kWordSpaces) - first + 1);
}

// Takes the first word off the line; empty at its end.
inline std::string_view takeWord(std::string_view& line) {
  line = trimSpaces(line);
  const std::string_view word = line.substr(0, line.find_first_of(kWordSpaces));
  line = trimSpaces(line.substr(word.size()));
  return word;
}

}  // namespace froth
