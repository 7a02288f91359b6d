// Watches every `new` of the test program.
#pragma once

#include <cstddef>

namespace froth {

void forgetAllocations();
size_t largestAllocation();  // [bytes] since the last forgetAllocations(), on all threads

}  // namespace froth
