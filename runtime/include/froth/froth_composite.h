/* Froth, into the engine's images: blends the foam's colour over the engine's colour, draws its depth into the depth
 * attachment.
 *
 * Optional: an engine can blend by itself (premultiplied: ONE, ONE_MINUS_SRC_ALPHA) and read FrothRenderInfo::depth.
 * These calls save it the passes. Call both outside a render pass, after the record call that drew the view in this
 * frame; once per view, eye and frame, else FROTH_ERROR_STATE. They write the pixels that the record call drew. A
 * format that was not declared at context creation costs nothing; its call returns FROTH_ERROR_UNSUPPORTED. Threads: at
 * once on different views, as frothRecordRaster. */
#ifndef FROTH_FROTH_COMPOSITE_H
#define FROTH_FROTH_COMPOSITE_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothCompositeInfo {
  uint32_t structSize;
  uint32_t eye;    /* as in FrothRenderInfo */
  FrothImage foam; /* FrothRenderInfo::colour of this frame; usage SAMPLED too */
  /* the engine's colour, in FrothContextInfo::compositeFormat; usage STORAGE. layoutIn UNDEFINED is refused */
  FrothImage target;
  /* factor on the foam's colour, not on its alpha: 1 = lit. R8_UNORM, R16_SFLOAT or R32_SFLOAT; usage SAMPLED; read at
   * the same pixel; null: 1 */
  FrothImage shadowFactor;
} FrothCompositeInfo;

/* target.rgb = shadow * foam.rgb + (1 - foam.a) * target.rgb; target.a = foam.a + (1 - foam.a) * target.a. On exit
 * compute pipeline, sets and push constants are undefined. */
FROTH_API FrothResult frothRecordComposite(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                           const FrothCompositeInfo* info);

typedef struct FrothDepthExportInfo {
  uint32_t structSize;
  uint32_t eye;     /* as in FrothRenderInfo */
  FrothImage depth; /* FrothRenderInfo::depth of this frame; usage SAMPLED too */
  /* the engine's depth, in FrothContextInfo::depthExportFormat; usage DEPTH_STENCIL_ATTACHMENT. The nearer depth stays,
   * by the camera that the view was drawn with. Stencil does not change */
  FrothImage attachment;
} FrothDepthExportInfo;

/* Draws the depth of the foam into the attachment, with dynamic rendering. On exit graphics pipeline, sets and dynamic
 * state are undefined. FROTH_ERROR_UNSUPPORTED also if the lens is not PROJECTION: `depth` then holds distances. */
FROTH_API FrothResult frothRecordDepthExport(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                             const FrothDepthExportInfo* info);

#ifdef __cplusplus
}
#endif
#endif
