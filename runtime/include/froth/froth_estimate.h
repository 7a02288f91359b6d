/* Froth, memory ahead of time: the bytes that an asset and a view of it will take.
 *
 * For budgets, before there is a device. The numbers come from the code that loads assets and makes views. The call
 * decodes the whole asset on its thread, so it takes as long as loading: call it in a tool or at a loading screen, and
 * keep the numbers. They hold for this version of the library. */
#ifndef FROTH_FROTH_ESTIMATE_H
#define FROTH_FROTH_ESTIMATE_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothEstimateInfo {
  uint32_t structSize;
  const FrothAssetInfo* asset; /* path or data, layers, keepForQueries and prepareRays count; no reader */
  /* maxExtent, lensClasses, keepsHits, keepsReactive, reserveCells and whether it fades count. Null: no view; its bytes
   * are then 0 */
  const FrothViewInfo* view;
  uint32_t walkShaders;           /* FrothContextInfo's */
  uint32_t framesInFlight;        /* [1..8] FrothContextInfo's; 0: 2 */
  FrothMessageCallback onMessage; /* may be null; called during the call, on its thread */
  void* messageUser;
} FrothEstimateInfo;

/* [bytes] A view of several instances, also of different assets: viewBytes once, and the viewInstanceBytes of each. */
typedef struct FrothMemoryEstimate {
  uint32_t structSize;
  /* device memory of the asset's arrays: exactly FrothAssetStatus::memory without "alignment, spare". deviceBytes,
   * which counts for the budget, is larger by that spare room of blocks, usually a few percent */
  uint64_t assetBytes;
  uint64_t assetHostBytes; /* exactly FrothAssetStatus::hostBytes; 0 without keepForQueries */
  uint64_t viewBytes;      /* device memory of the view, whatever it shows */
  /* device memory of the view for each instance. With viewBytes exactly FrothViewStatus::deviceBytes of the first
   * frame. The budget counts each allocation as the device rounds it up, and a few texels. A view grows where frames
   * want more than reserveCells cells, or more pairs than there is room for; while it does, it also holds what it
   * replaces */
  uint64_t viewInstanceBytes;
  uint64_t viewInstanceHostBytes; /* host memory of the view for each instance: staging and read-back */
} FrothMemoryEstimate;

/* Any thread, at any time, without a context. Holds one decoded chunk at a time; with keepForQueries also what queries
 * will keep. A bad file: FROTH_ERROR_FILE or FROTH_ERROR_VERSION, and a message. */
FROTH_API FrothResult frothEstimateMemory(const FrothEstimateInfo* info, FrothMemoryEstimate* estimate);

#ifdef __cplusplus
}
#endif
#endif
