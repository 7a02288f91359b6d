// CUDA's errors as Froth's.
#pragma once

#include <cuda_runtime_api.h>

#include "base/result.h"

namespace froth {

// what: the call and its sizes, as in "cudaMalloc of 96 bytes for 'balls'".
inline Status checkCuda(cudaError_t code, const char* what) {
  if (code == cudaSuccess) return {};
  const ErrorKind kind = code == cudaErrorMemoryAllocation ? ErrorKind::kMemory : ErrorKind::kDevice;
  return makeError(kind, "%s: %s (%s)", what, cudaGetErrorString(code), cudaGetErrorName(code));
}

// After a launch.
inline Status checkLaunch(const char* kernel) { return checkCuda(cudaGetLastError(), kernel); }

}  // namespace froth
