// The library is linked into a program, whose operator new is its own too.
#include "runtime/heap/host_allocator.h"

namespace froth {

FrothResult setHostAllocator(const FrothHostAllocator*) { return FROTH_ERROR_UNSUPPORTED; }

}  // namespace froth
