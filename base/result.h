// How Froth reports failure: a value, or an error that a person can act on.
//
// Every function that can fail returns Status or Result<T>. The message names the cause, the place, the value that
// was found and the remedy: "scene.froth: chunk 17, section 'neighbours': cell 70210 >= 65536; bake the scene again".
#pragma once

#include <cstdarg>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

namespace froth {

enum class ErrorKind {
  kBadInput,     // a file or its content is wrong: exit code 3
  kUsage,        // the caller asked for something that does not exist: exit code 2
  kIo,           // the operating system refused: exit code 1
  kUnsupported,  // the device or this build cannot do it: exit code 1
  kMemory,       // host or device memory, or a budget, is exhausted: exit code 1
  kDevice,       // a Vulkan call failed: exit code 1
  kCancelled,    // Ctrl-C or the caller's stop request: exit code 1
};

struct Error {
  ErrorKind kind = ErrorKind::kBadInput;
  std::string message;
};

[[nodiscard, gnu::format(printf, 2, 3)]] inline Error makeError(ErrorKind kind, const char* format, ...) {
  va_list args, counted;
  va_start(args, format);
  va_copy(counted, args);
  const int length = std::vsnprintf(nullptr, 0, format, counted);
  va_end(counted);
  std::string message(length > 0 ? static_cast<size_t>(length) : 0, '\0');
  std::vsnprintf(message.data(), message.size() + 1, format, args);
  va_end(args);
  return {kind, std::move(message)};
}

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}

  explicit operator bool() const { return value_.has_value(); }
  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }
  const Error& error() const { return error_; }  // only if there is no value

 private:
  std::optional<T> value_;
  Error error_;
};

class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_(std::move(error)) {}

  explicit operator bool() const { return !error_.has_value(); }  // true: it went well
  const Error& error() const { return *error_; }                  // only if it did not

 private:
  std::optional<Error> error_;
};

}  // namespace froth
