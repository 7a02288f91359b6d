/* Froth, host memory: an allocator of the engine for all that the library allocates itself.
 *
 * One for the process: it is the one thing that Froth keeps beside its contexts. The shared library has an operator new
 * of its own, with its own copy of the C++ library inside, so all that its code takes comes from here: contexts,
 * assets, decoders, also on the threads of jobs. docs/EMBEDDING.md lists what does not: it is the driver's, and what
 * the C++ library needs for exceptions. */
#ifndef FROTH_FROTH_HOST_H
#define FROTH_FROTH_HOST_H

#include "froth/froth_context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Both are called on the thread of a call of Froth or of a job, on several threads at once. They must not call Froth,
 * and no exception may leave them. */
typedef struct FrothHostAllocator {
  uint32_t structSize;
  /* size [bytes, > 0], alignment [a power of two, >= 16]. Null: there is no memory, and the call of Froth that wanted
   * it returns FROTH_ERROR_MEMORY, or the asset whose job did becomes FAILED */
  void* (*allocate)(void* user, size_t size, size_t alignment);
  /* pointer: of allocate, never null; size and alignment: as they were given there */
  void (*release)(void* user, void* pointer, size_t size, size_t alignment);
  void* user;
} FrothHostAllocator;

/* The fields are copied. Null: malloc and free, as at the start. Call it before all other calls of Froth, or when no
 * context is left; no other call of Froth, and no job, may run meanwhile. Nothing is changed on an error, and as there
 * is no context, no message is sent:
 *   FROTH_ERROR_STATE        blocks of the present allocator are alive: contexts, or jobs that have not been called yet
 *   FROTH_ERROR_ARGUMENT     allocate or release is null, or structSize is not set
 *   FROTH_ERROR_VERSION      structSize is larger than this library knows, and fields beyond are not zero
 *   FROTH_ERROR_UNSUPPORTED  the library is static, or built with sanitizers: operator new is the program's. Replace it
 *                            there; Froth then uses that */
FROTH_API FrothResult frothSetHostAllocator(const FrothHostAllocator* allocator);

#ifdef __cplusplus
}
#endif
#endif
