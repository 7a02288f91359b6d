// What `froth` returns to the shell.
#pragma once

#include "base/result.h"

namespace froth {

enum ExitCode : int {
  kExitWell = 0,
  kExitFailed = 1,
  kExitUsage = 2,
  kExitBadInput = 3,
};

inline ExitCode exitCodeOf(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kBadInput:
      return kExitBadInput;
    case ErrorKind::kUsage:
      return kExitUsage;
    case ErrorKind::kIo:
    case ErrorKind::kUnsupported:
    case ErrorKind::kMemory:
    case ErrorKind::kDevice:
    case ErrorKind::kCancelled:
      break;
  }
  return kExitFailed;
}

}  // namespace froth
