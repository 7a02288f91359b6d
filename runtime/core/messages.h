// Sends messages to the caller's callback; never prints.
#pragma once

#include "froth/froth.h"

namespace froth {

// Thread safety: any thread, if the caller's callback allows it.
struct Messages {
  FrothMessageCallback callback = nullptr;  // may be null
  void* user = nullptr;

  // Sends an error and returns its code, so that a check reads `return messages.fail(...)`.
#if defined(__GNUC__)
  __attribute__((format(printf, 4, 5)))
#endif
  FrothResult
  fail(FrothResult code, const char* object, const char* format, ...) const;
};

}  // namespace froth
