/* Froth, pipelines ahead of time: what drivers compile for seconds when they first see it, at a loading screen.
 *
 * Without these calls an asset stays OPENING until its pipelines are made, and a second instance is not drawn before
 * those that draw several are. With FrothContextInfo::runJob no frame waits for them either way. Give a
 * FrothContextInfo::pipelineCache with the data of the last run, and they are there in milliseconds. */
#ifndef FROTH_FROTH_PRECOMPILE_H
#define FROTH_FROTH_PRECOMPILE_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the shaders that draw an asset are specialized on. Opaque; equal bytes need the same pipelines; valid for all
 * contexts of this version of the library. */
typedef struct FrothVariant {
  uint32_t words[8];
} FrothVariant;

/* Reads it from the head of a file, or of its bytes: info's path or data, and layers. Any thread. A bad file:
 * FROTH_ERROR_FILE or FROTH_ERROR_VERSION, and a message on this thread. */
FROTH_API FrothResult frothReadVariant(FrothContext* context, const FrothAssetInfo* info, FrothVariant* variant);

/* done: of `total` steps of work; on the thread of frothPrecompile. It must not call Froth. */
typedef void (*FrothProgressCallback)(void* user, uint32_t done, uint32_t total);

typedef struct FrothPrecompileInfo {
  uint32_t structSize;
  uint32_t variantCount;
  const FrothVariant* variants;     /* [variantCount] */
  uint32_t severalInstances;        /* 1: also what draws several instances, and casts rays through them */
  FrothProgressCallback onProgress; /* may be null */
  void* progressUser;
} FrothPrecompileInfo;

/* Returns when the pipelines are made; those that are there cost nothing. Any thread, also while frames go on; not
 * while frothDestroyContext, frothDeviceLost or frothRestoreDevice runs. The driver writes
 * FrothContextInfo::pipelineCache meanwhile: it must not be created with EXTERNALLY_SYNCHRONIZED. */
FROTH_API FrothResult frothPrecompile(FrothContext* context, const FrothPrecompileInfo* info);

#ifdef __cplusplus
}
#endif
#endif
