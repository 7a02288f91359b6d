// Sends messages to the caller's callback; never prints.
#pragma once

#include "base/result.h"
#include "froth/froth.h"

namespace froth {

// What an error of the format or of Vulkan is to the caller.
FrothResult resultOf(const Error& error);

// Thread safety: any thread, if the caller's callback allows it. Allocates nothing, so that it can tell that
// memory is exhausted; texts beyond 4 KiB are cut.
struct Messages {
  FrothMessageCallback callback = nullptr;  // may be null
  void* user = nullptr;

  // Sends an error and returns its code, so that a check reads `return messages.fail(...)`.
#if defined(__GNUC__)
  __attribute__((format(printf, 4, 5)))
#endif
  FrothResult
  fail(FrothResult code, const char* object, const char* format, ...) const;

  FrothResult fail(const Error& error, const char* object) const {
    return fail(resultOf(error), object, "%s", error.message.c_str());
  }

#if defined(__GNUC__)
  __attribute__((format(printf, 4, 5)))
#endif
  void
  warn(FrothResult code, const char* object, const char* format, ...) const;
};

}  // namespace froth
