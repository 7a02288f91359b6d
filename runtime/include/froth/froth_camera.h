/* Froth, cameras: images of the caller, lenses, cameras.
 *
 * Included by froth.h, which states the conventions of all calls. */
#ifndef FROTH_FROTH_CAMERA_H
#define FROTH_FROTH_CAMERA_H

#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The structs of this header lie within others, so their size never changes. Later versions add to them by a chain.
 * This version knows no kind: a chain that is not null gives FROTH_ERROR_VERSION. */
typedef struct FrothExtension {
  uint32_t kind;
  const struct FrothExtension* next;
} FrothExtension;

/* An image of the caller. image = null: not wanted; costs nothing. Froth transitions the image from its entry state,
 * and to its exit state. It remembers nothing between calls. layoutIn = UNDEFINED discards the contents. stageIn is not
 * 0: a frame before may still read what is discarded. stageOut may be 0 with accessOut 0, before a semaphore. */
typedef struct FrothImage {
  VkImage image;
  VkImageView view; /* 2D, one level, identity swizzle. Usage STORAGE; for an input SAMPLED */
  uint32_t layer;   /* array layer that `view` shows; Froth touches no other */
  VkFormat format;
  VkExtent2D extent;
  VkImageLayout layoutIn, layoutOut;
  VkPipelineStageFlags2 stageIn, stageOut;
  VkAccessFlags2 accessIn, accessOut;
  VkSampleCountFlagBits samples;   /* 0 or 1; multisampled images are refused */
  const FrothExtension* extension; /* null */
} FrothImage;

/* Which ray a pixel sees. All kinds but the first take the view's axes as x right, y down, z forward, and ignore
 * clipFromView. The centre of the first pixel is (0.5, 0.5) from the viewport's upper left corner. (u, v) = (pixel -
 * centre) / focal. */
typedef enum FrothLensKind {
  FROTH_LENS_PROJECTION = 0,        /* by clipFromView; the other fields of FrothLens are not read */
  FROTH_LENS_FISHEYE = 1,           /* equidistant: |(u, v)| is the angle from the axis */
  FROTH_LENS_KANNALA_BRANDT = 2,    /* OpenCV's fisheye; coefficients k1, k2, k3, k4 */
  FROTH_LENS_RADIAL_TANGENTIAL = 3, /* OpenCV's; coefficients k1, k2, p1, p2, k3, k4, k5, k6 */
  /* u is the longitude to the right, v the latitude downwards. focal {0, 0}: the viewport shows the whole sphere, and
   * centre is not read */
  FROTH_LENS_EQUIRECTANGULAR = 4,
  FROTH_LENS_RAY_MAP = 5, /* the direction in the caller's image */
  FROTH_LENS_MAX = 0x7fffffff
} FrothLensKind;

/* Pixels without a ray are cleared: beyond half a turn, or where a distortion folds (docs/CAMERAS.md). */
typedef struct FrothLens {
  FrothLensKind kind;
  float focal[2];  /* [pixels per radian; RADIAL_TANGENTIAL: per tangent], > 0 */
  float centre[2]; /* [pixels] */
  float coefficients[8];
  /* RAY_MAP: R32G32B32A32_SFLOAT with usage SAMPLED, read at the pixels that are drawn. xyz: a direction of any length
   * in the view's axes; 0: the pixel is cleared. All rays start at the eye. */
  FrothImage rayMap;
  const FrothExtension* extension; /* null */
} FrothLens;

typedef struct FrothCamera {
  double eye[3];          /* in the world */
  float viewFromWorld[9]; /* rotation, column-major, into the axes that clipFromView takes */
  /* without jitter; any perspective projection: reversed, infinite, off-centre, oblique. Row w = (0, 0, 0, w): parallel
   * rays. They start on the plane through the eye, perpendicular to them. They point away from a viewer who sees x to
   * the right and y down on the image. Colours are seen along them */
  float clipFromView[16];
  float jitter[2];     /* [pixels] +x right, +y down; 0 with a ray map, which can contain it */
  VkViewport viewport; /* the height may be negative */
  /* zero: the whole viewport. Viewport and scissor together must lie in the images and fit maxExtent */
  VkRect2D scissor;
  FrothLens lens; /* zero: clipFromView alone. Other kinds need their bit in FrothViewInfo::lensClasses */
  const FrothExtension* extension; /* null */
} FrothCamera;

#ifdef __cplusplus
}
#endif
#endif
