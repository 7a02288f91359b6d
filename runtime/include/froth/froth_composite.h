/* Froth, into the engine's own images: the foam's colour over the engine's.
 *
 * An engine can blend by itself (premultiplied: ONE, ONE_MINUS_SRC_ALPHA); this is for those that would have to write a pass for
 * it. What is not declared at context creation costs nothing. Threads: as frothRasterize, at once on different views. */
#ifndef FROTH_FROTH_COMPOSITE_H
#define FROTH_FROTH_COMPOSITE_H

#include "froth/froth.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothCompositeInfo {
  uint32_t structSize;
  FrothImage foam;         /* FrothRenderInfo::colour of this frame; usage SAMPLED too */
  FrothImage target;       /* the engine's colour, of FrothContextInfo::compositeFormat; usage STORAGE */
  FrothImage shadowFactor; /* a factor on the foam's colour, not on its alpha: 1 = lit. R8_UNORM, R16_SFLOAT or R32_SFLOAT, usage
                              SAMPLED, pixel for pixel; null: 1 */
  VkRect2D region;         /* the pixels that are blended, the same ones of all images; zero: as many as `foam` has */
} FrothCompositeInfo;

/* target = shadow foam + (1 - foam.a) target, alpha too: foam.a + (1 - foam.a) target.a. Outside a render pass, after the record
 * call that drew the foam in this frame; once per view and frame. On exit compute pipeline, sets and push constants are undefined.
 * FROTH_ERROR_UNSUPPORTED: FrothContextInfo::compositeFormat was not set. FROTH_ERROR_STATE: the view was not drawn in this frame. */
FROTH_API FrothResult frothComposite(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                     const FrothCompositeInfo* info);

#ifdef __cplusplus
}
#endif
#endif
