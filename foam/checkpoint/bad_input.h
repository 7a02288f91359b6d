// Errors about the content of a checkpoint.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/result.h"

namespace froth {

// Bytes of a checkpoint and what messages call them; the bytes outlive every view into them.
struct NamedBytes {
  std::span<const uint8_t> bytes;
  std::string name;
};

template <class... Args>
[[nodiscard]] Error badInput(std::string_view file, fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorKind::kBadInput, fmt::format("{}: {}", file, fmt::format(format, std::forward<Args>(args)...))};
}

// A name taken from a file, fit for a terminal: quoted, at most 80 characters, all of them printable ASCII.
inline std::string quoted(std::string_view name) {
  constexpr size_t kMaxShown = 80;
  std::string shown = "'";
  for (const char c : name.substr(0, kMaxShown)) {
    shown += c >= ' ' && c <= '~' ? c : '?';
  }
  return shown + (name.size() > kMaxShown ? "...'" : "'");
}

}  // namespace froth
