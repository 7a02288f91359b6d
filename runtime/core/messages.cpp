#include "runtime/core/messages.h"

#include <cstdarg>
#include <cstdio>
#include <vector>

namespace froth {

FrothResult Messages::fail(FrothResult code, const char* object, const char* format, ...) const {
  if (!callback) {
    return code;
  }
  va_list args, counted;
  va_start(args, format);
  va_copy(counted, args);
  const int length = std::vsnprintf(nullptr, 0, format, counted);
  va_end(counted);
  std::vector<char> text(length > 0 ? static_cast<size_t>(length) + 1 : 1);
  std::vsnprintf(text.data(), text.size(), format, args);
  va_end(args);
  callback(user, FROTH_SEVERITY_ERROR, code, object, text.data());
  return code;
}

}  // namespace froth
