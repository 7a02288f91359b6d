// Watches every `new` of the test program.
#pragma once

#include <cstddef>

namespace froth {

void forgetAllocations();
// Since the last forgetAllocations(), on all threads [bytes].
size_t largestAllocation();
size_t allocatedBytes();  // what was freed meanwhile counts too

}  // namespace froth
