#include "base/text.h"

#include <cstdint>
#include <cstdio>

namespace froth {
namespace {

// A character at the front of `text`; length 0: the first byte begins none.
struct Character {
  size_t length = 0;
  uint32_t code = 0;
};

Character firstCharacter(std::string_view text) {
  const auto byteAt = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t lead = byteAt(0);
  if (lead < 0x80) return {1, lead};
  const size_t length = lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
  if (length == 0 || text.size() < length) return {};
  uint32_t code = lead & (0x7fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if (byteAt(i) >> 6 != 2) return {};
    code = code << 6 | (byteAt(i) & 0x3fu);
  }
  constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // less has a shorter form
  const bool isSurrogate = code >= 0xd800 && code <= 0xdfff;
  return code >= kLeast[length] && code <= 0x10ffff && !isSurrogate ? Character{length, code} : Character{};
}

bool isControl(uint32_t code) { return code < 0x20 || (code >= 0x7f && code < 0xa0); }

}  // namespace

bool isUtf8(std::string_view text) {
  while (!text.empty()) {
    const size_t length = firstCharacter(text).length;
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const Character first = firstCharacter(text);
    const bool isShown = first.length > 0 && !isControl(first.code);
    const size_t length = first.length > 0 ? first.length : 1;
    for (const char byte : text.substr(0, length)) {
      char escaped[5];
      std::snprintf(escaped, sizeof(escaped), "\\x%02x", static_cast<unsigned>(static_cast<uint8_t>(byte)));
      if (isShown) {
        shown += byte;
      } else {
        shown += escaped;
      }
    }
    text.remove_prefix(length);
  }
  return shown;
}

}  // namespace froth
