/* Froth, into the engine's own images: the foam's colour over the engine's, its depth into the engine's depth attachment.
 *
 * An engine can blend by itself (premultiplied: ONE, ONE_MINUS_SRC_ALPHA), and read FrothRenderInfo::depth; this is for those that
 * would have to write a pass for it. Both are called outside a render pass, after the record call that drew the view in this frame,
 * and write the pixels that it drew; once per view, eye and frame, else FROTH_ERROR_STATE. What is not declared at context creation costs
 * nothing, and gives FROTH_ERROR_UNSUPPORTED. Threads: at once on different views, as frothRasterize. */
#ifndef FROTH_FROTH_COMPOSITE_H
#define FROTH_FROTH_COMPOSITE_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothCompositeInfo {
  uint32_t structSize;
  uint32_t eye;            /* as it was drawn */
  FrothImage foam;         /* FrothRenderInfo::colour of this frame; usage SAMPLED too */
  FrothImage target;       /* the engine's colour, of FrothContextInfo::compositeFormat; usage STORAGE. layoutIn UNDEFINED is refused */
  FrothImage shadowFactor; /* a factor on the foam's colour, not on its alpha: 1 = lit. R8_UNORM, R16_SFLOAT or R32_SFLOAT, usage
                              SAMPLED, pixel for pixel; null: 1 */
} FrothCompositeInfo;

/* target = shadow foam + (1 - foam.a) target, alpha too: foam.a + (1 - foam.a) target.a. On exit compute pipeline, sets and push
 * constants are undefined. */
FROTH_API FrothResult frothComposite(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                     const FrothCompositeInfo* info);

typedef struct FrothDepthExportInfo {
  uint32_t structSize;
  uint32_t eye;          /* as it was drawn */
  FrothImage depth;      /* FrothRenderInfo::depth of this frame; usage SAMPLED too */
  FrothImage attachment; /* the engine's depth, of FrothContextInfo::depthExportFormat; usage DEPTH_STENCIL_ATTACHMENT. What is nearer
                            stays, by the camera that the view was drawn with; stencil stays */
} FrothDepthExportInfo;

/* Draws the depth of the foam into the attachment, in dynamic rendering. On exit graphics pipeline, sets and dynamic state are
 * undefined. FROTH_ERROR_UNSUPPORTED too: the lens was no projection, so that `depth` is a distance. */
FROTH_API FrothResult frothRecordDepthExport(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                             const FrothDepthExportInfo* info);

#ifdef __cplusplus
}
#endif
#endif
