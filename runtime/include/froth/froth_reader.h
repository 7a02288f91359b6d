/* Froth, readers: assets from the engine's own file system (packs, asynchronous I/O), range by range.
 *
 *   void readRange(void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
 *     enqueue(user, offset, size, destination, request);  // done: frothCompleteRead(context, request, FROTH_OK)
 *   }
 *   FrothReader reader = {.structSize = sizeof reader, .user = pack, .name = "gallery", .size = n, .read = readRange};
 *   FrothAssetInfo info = {.structSize = sizeof info, .reader = &reader};
 *
 * Ranges: the first 64 KiB, the rest of a longer head, then chunk by chunk the sections of the layers that are loaded,
 * a range for each layer in files of froth bake. What lies behind the head is read once, but for chunks within the
 * first 64 KiB, and after a lost device or where the budget changes its layers (frothSetBudget): then the asset loads
 * again.
 *
 * Bounds: of all assets together at most 32 ranges and 16 MiB are asked for and not decoded yet; a chunk or head beyond
 * that is read alone. A read that is cancelled and not answered counts, too: a reader that never answers keeps others
 * waiting.
 *
 * Bytes from a reader are trusted no more than those of a file. */
#ifndef FROTH_FROTH_READER_H
#define FROTH_FROTH_READER_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Brings the bytes [offset, offset + size) of the asset to `destination` and answers with frothCompleteRead, once: now
 * or later, on any thread. The range lies within FrothReader::size; size > 0. `destination` is Froth's, and stays valid
 * until the answer, whatever happens to the asset. `request` is unique in the context, and not 0. Called in
 * frothUpdate, on its thread. Of Froth it may call frothCompleteRead alone. */
typedef void (*FrothReadRange)(void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination);

/* A wish: nobody needs the bytes any more. The read must be answered all the same, with any result; another thread may
 * have done it just now. Called once at most for a request, in frothUpdate (the asset failed), frothCloseAsset,
 * frothDeviceLost and frothDestroyContext. Of Froth it may call frothCompleteRead alone. */
typedef void (*FrothCancelRead)(void* user, uint64_t request);

typedef struct FrothReader {
  uint32_t structSize;
  void* user;       /* any value, for the callbacks; valid until asset or context is gone and all reads are answered */
  const char* name; /* of the asset, in messages; copied. May be null */
  uint64_t size;    /* [bytes, > 0] of the whole asset */
  FrothReadRange read;
  FrothCancelRead cancel; /* may be null */
} FrothReader;

/* Answers a read. FROTH_OK: the bytes are there. An error: the asset FAILS, with a message that names it, the range and
 * this error; FrothAssetStatus::error is FROTH_ERROR_MEMORY if this is, else FROTH_ERROR_FILE. Any thread, at any time
 * until frothDestroyContext returns FROTH_OK; within `read` and `cancel`, too. It waits for no frame.
 *
 * FROTH_ERROR_HANDLE: no such request, or it is answered. FROTH_ERROR_ARGUMENT: `result` is information (> 0), which
 * answers nothing. In both cases nothing changes; the message comes on this thread. */
FROTH_API FrothResult frothCompleteRead(FrothContext* context, uint64_t request, FrothResult result);

#ifdef __cplusplus
}
#endif
#endif
