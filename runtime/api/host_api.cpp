#include "froth/froth_host.h"
#include "runtime/api/struct_size.h"
#include "runtime/heap/host_allocator.h"

using namespace froth;

FrothResult frothSetHostAllocator(const FrothHostAllocator* allocator) {
  if (!allocator) {
    return setHostAllocator(nullptr);
  }
  FrothHostAllocator known;
  if (const FrothResult result = readStruct(*allocator, known); result != FROTH_OK) {
    return result;
  }
  return known.allocate && known.release ? setHostAllocator(&known) : FROTH_ERROR_ARGUMENT;
}
