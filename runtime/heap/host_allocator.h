// Who gives the library its host memory. Two sources define it, and each library has one of them: own_heap.cpp, of the
// shared library, and program_heap.cpp.
#pragma once

#include "froth/froth_host.h"

namespace froth {

// Of checked fields; null: malloc. The results are those of frothSetHostAllocator.
FrothResult setHostAllocator(const FrothHostAllocator* allocator);

}  // namespace froth
