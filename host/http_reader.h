// An asset on an HTTP server: a FrothReader over libcurl, to use or to copy.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/result.h"
#include "froth/froth_reader.h"

namespace froth {

inline bool isUrl(const std::string& place) { return place.starts_with("http://") || place.starts_with("https://"); }

struct HttpOptions {
  double connectSeconds = 10;
  double stallSeconds = 20;  // a transfer that brings no byte for so long has failed
};

// Ranges come side by side, over connections that stay open. A transfer that fails in a way that may pass (a cut
// connection, a stall, 408, 429, 5xx) is tried twice more. A server that ignores ranges is refused, and so is an answer
// out of a file of another size. One thread of its own; calls: as FrothReader and frothCompleteRead say.
class HttpReader {
 public:
  // Waits for the first bytes of the file, which tell its size. Without libcurl: an error that says so.
  static Result<std::unique_ptr<HttpReader>> open(const std::string& url, FrothContext* context,
                                                  const HttpOptions& options = {});
  // Answers all reads at once, as frothCloseFile does and when it may be called.
  ~HttpReader();

  FrothReader reader();           // whose callbacks mean this object
  std::string lastFault() const;  // of the newest read that failed for good; any thread

  uint64_t retries() const;  // any thread

 private:
  struct State;
  explicit HttpReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace froth
