// Strings of files, which may hold anything.
#pragma once

#include <string>
#include <string_view>

namespace froth {

// Whether the bytes are well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF).
bool isUtf8(std::string_view text);

// Text for a terminal or a message: control characters (C0, DEL, C1) and bytes that are no UTF-8 become \xNN. The
// result is UTF-8.
std::string printable(std::string_view text);

}  // namespace froth
