#include "runtime/device/messages.h"

#include <cstdarg>
#include <cstdio>

namespace froth {
namespace {

void send(const Messages& messages, FrothSeverity severity, FrothResult code, const char* object, const char* format,
          va_list args) {
  if (!messages.callback) {
    return;
  }
  char text[4096];
  std::vsnprintf(text, sizeof(text), format, args);
  messages.callback(messages.user, severity, code, object, text);
}

}  // namespace

FrothResult resultOf(const Error& error) {
  switch (error.kind) {
    case ErrorKind::kMemory:
      return FROTH_ERROR_MEMORY;
    case ErrorKind::kDevice:
      return FROTH_ERROR_DEVICE;
    case ErrorKind::kUnsupported:
      return FROTH_ERROR_VERSION;
    case ErrorKind::kBadInput:
    case ErrorKind::kUsage:
    case ErrorKind::kIo:
    case ErrorKind::kCancelled:
      break;
  }
  return FROTH_ERROR_FILE;
}

FrothResult Messages::fail(FrothResult code, const char* object, const char* format, ...) const {
  va_list args;
  va_start(args, format);
  send(*this, FROTH_SEVERITY_ERROR, code, object, format, args);
  va_end(args);
  return code;
}

void Messages::warn(FrothResult code, const char* object, const char* format, ...) const {
  va_list args;
  va_start(args, format);
  send(*this, FROTH_SEVERITY_WARNING, code, object, format, args);
  va_end(args);
}

}  // namespace froth
