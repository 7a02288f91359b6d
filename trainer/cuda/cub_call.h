// CUB's device calls: first they say how much scratch memory they need, then they work in it.
#pragma once

#include "trainer/cuda/passes.h"

namespace froth {

template <class Call>
Status callCub(Scratch& scratch, const char* what, const Call& call) {
  size_t bytes = 0;
  if (Status asked = checkCuda(call(nullptr, bytes), what); !asked) return asked;
  if (bytes > scratch.size()) {
    if (Status resized = scratch.resize(bytes, what); !resized) return resized;
  }
  bytes = scratch.size();
  return checkCuda(call(scratch.data(), bytes), what);
}

}  // namespace froth
