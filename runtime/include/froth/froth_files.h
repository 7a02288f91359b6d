/* Froth, files: a FrothReader over a file or a part of one, for applications without I/O of their own. Link
 * froth::files.
 *
 *   FrothFileInfo info = {.structSize = sizeof info, .path = "data.pack", .offset = at, .size = bytes,
 *                         .runJob = frothRunInPool, .jobUser = ioPool};
 *   frothOpenFile(context, &info, &file);
 *   FrothAssetInfo opened = {.structSize = sizeof opened, .reader = frothGetFileReader(file)};
 *   frothOpenAsset(context, &opened, &asset);
 *   ...
 *   frothDestroyContext(context, UINT64_MAX);  // FROTH_PENDING: a read is under way
 *   frothCloseFile(file);                      // waits for it
 *   frothDestroyContext(context, UINT64_MAX);  // FROTH_OK
 *
 * Beside FrothAssetInfo::path, which is read by the jobs that decode, reads have threads of their own here: those jobs
 * wait for no disk. */
#ifndef FROTH_FROTH_FILES_H
#define FROTH_FROTH_FILES_H

#include "froth/froth_reader.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothFile FrothFile;

typedef struct FrothFileInfo {
  uint32_t structSize;
  const char* path; /* a regular file; read during the call */
  uint64_t offset;  /* [bytes] where the asset begins, as in a pack */
  uint64_t size;    /* [bytes] of the asset; 0: up to the end of the file */
  /* Takes each read and runs it on a thread of the caller's: its scheduler, or frothRunInPool (froth_pool.h) with a
   * pool for I/O. Null: a read is done within frothUpdate, which waits for the disk; frames are then the same on each
   * run */
  FrothRunJob runJob;
  void* jobUser;
} FrothFileInfo;

/* FROTH_ERROR_ARGUMENT: a null pointer, structSize is not set, or the file does not hold offset and size.
 * FROTH_ERROR_FILE: the path cannot be opened, errno tells why; or it is no regular file, errno is 0.
 * FROTH_ERROR_MEMORY: host memory is exhausted. *file is null on an error. No message is sent. */
FrothResult frothOpenFile(FrothContext* context, const FrothFileInfo* info, FrothFile** file);

/* For FrothAssetInfo::reader, of any number of assets of that context. Valid until the file is closed. */
const FrothReader* frothGetFileReader(const FrothFile* file);

/* Answers the reads that have not begun with FROTH_ERROR_STATE, waits for those that have, and frees the file; on any
 * thread. Its assets are closed by then, or frothDestroyContext has given FROTH_PENDING or FROTH_OK and no frothUpdate
 * follows. Jobs that runJob has not run yet then do nothing. A null pointer does nothing. */
void frothCloseFile(FrothFile* file);

#ifdef __cplusplus
}
#endif
#endif
