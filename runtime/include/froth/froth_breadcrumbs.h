/* Froth, breadcrumbs: which pass of which view the GPU was in when it hung.
 *
 * With FrothContextInfo::breadcrumbs the GPU writes two numbers per pass of a view to host-visible memory: one before
 * the pass, when all commands before it are finished, and one after it, when its own are. So no two passes overlap, and
 * frames are slower. Without the option the commands are as if this header were not there.
 *
 * A number is written by vkCmdFillBuffer between two barriers, the second one to the host. Vulkan promises that the
 * host sees it when the submission is complete. It promises nothing of a submission that never is: drivers that write
 * coherent memory at the barrier show it then, others may show the pass as not begun, or not finished. Marks of a
 * vendor (VK_AMD_buffer_marker, VK_NV_device_diagnostic_checkpoints) around the record calls promise more; Froth needs
 * no extension.
 *
 * Uploads, froth_walk.h and what a record call does before its first pass leave none. */
#ifndef FROTH_FROTH_BREADCRUMBS_H
#define FROTH_FROTH_BREADCRUMBS_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothBreadcrumb {
  FrothView view;
  uint64_t serial;  /* of the frame that it is recorded in */
  const char* call; /* "frothRecordRaster", "frothRecordWalk", "frothRecordComposite" or "frothRecordDepthExport" */
  const char* pass; /* as FrothPassTime::name, or "composite", "export_depth". "aim" lies within "cull" */
  uint32_t eye;
  /* begun and not finished: the GPU is in this pass, or was when it hung. Neither: it has not come to it, or the frame
   * is not submitted */
  uint32_t isBegun, isFinished;
} FrothBreadcrumb;

/* Copies at most `capacity` breadcrumbs, by view, and those of a view in the order in which they were recorded. *count:
 * the number that there are; capacity 0: breadcrumbs may be null. The strings have static storage.
 *
 * A view has the passes of the newest frames, at least of those in flight; not of dropped frames. A view that is
 * destroyed has none. At any time: while the GPU works, after VK_ERROR_DEVICE_LOST, and between frothDeviceLost, which
 * keeps them, and frothRestoreDevice, which begins anew. Waits for nothing, allocates nothing.
 *
 * FROTH_ERROR_UNSUPPORTED: the context was made without FrothContextInfo::breadcrumbs. */
FROTH_API FrothResult frothGetBreadcrumbs(FrothContext* context, uint32_t capacity, FrothBreadcrumb* breadcrumbs,
                                          uint32_t* count);

#ifdef __cplusplus
}
#endif
#endif
