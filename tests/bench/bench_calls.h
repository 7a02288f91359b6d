// Ends a bench with a message when something that it builds on fails.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/result.h"
#include "froth/froth.h"

namespace froth {

inline void require(bool isWell, const std::string& what) {
  if (isWell) return;
  std::fprintf(stderr, "%s\n", what.c_str());
  std::exit(1);
}

// FROTH_INCOMPLETE is no failure.
inline void check(FrothResult result, const char* call) {
  require(result >= 0, std::string(call) + ": " + frothResultName(result));
}

inline void check(const Status& status) { require(bool(status), status ? "" : status.error().message); }

template <class T>
T take(Result<T> result) {
  require(bool(result), result ? "" : result.error().message);
  return std::move(*result);
}

}  // namespace froth
