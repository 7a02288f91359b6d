/* Froth, hot reload: another file takes the place of an asset while frames go on.
 *
 * The new file loads beside the old one. The old one is drawn until the new one is whole, or with levels of detail
 * until its floor is; then the next frothUpdate exchanges them. The handle of the asset and all instances stay. If the
 * new file cannot be loaded, or the budget does not hold both, the old one stays.
 *
 * Threads: as all calls that take a context (froth.h): one at a time. */
#ifndef FROTH_FROTH_REPLACE_H
#define FROTH_FROTH_REPLACE_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Begins it; returns at once. info: as for frothOpenAsset; it may name the same path, if another file stands there by
 * now: replace the file by renaming, do not write into it, for the old asset may still read it. A call while an earlier
 * replacement of the asset is loading ends that one, and it never shows. frothCloseAsset ends it, too. Ids of cells are
 * those of the new file from the exchange on, and FrothAssetStatus is of the asset that is drawn.
 *
 * FROTH_ERROR_HANDLE: no such asset. FROTH_ERROR_ARGUMENT: as frothOpenAsset. FROTH_ERROR_STATE: the asset is not
 * READY; close it and open the other file. */
FROTH_API FrothResult frothReplaceAsset(FrothContext* context, FrothAsset asset, const FrothAssetInfo* info);

typedef enum FrothReplacementState {
  FROTH_REPLACEMENT_NONE = 0,
  FROTH_REPLACEMENT_LOADING = 1, /* the old file is drawn */
  FROTH_REPLACEMENT_DONE = 2,    /* the new file is drawn, from the next recording on */
  FROTH_REPLACEMENT_FAILED = 3,  /* the old file stays; one warning told why */
  FROTH_REPLACEMENT_STATE_MAX = 0x7fffffff
} FrothReplacementState;

/* Of the newest frothReplaceAsset of the asset, as of the newest frothUpdate. */
typedef struct FrothReplacementStatus {
  uint32_t structSize;
  FrothReplacementState state;
  FrothResult error; /* why it FAILED: FROTH_ERROR_MEMORY if the budget did not hold both, FROTH_ERROR_DEVICE if the
                        device was lost meanwhile, or as FrothAssetStatus::error */
} FrothReplacementStatus;

FROTH_API FrothResult frothGetReplacement(FrothContext* context, FrothAsset asset, FrothReplacementStatus* status);

#ifdef __cplusplus
}
#endif
#endif
