// Rays for one pixel in room.counts.z along each axis. Pixels between them take the mean of those rays around them that
// start on the same surface; where none does, a ray of their own. After Kopf et al., "Joint Bilateral Upsampling" (2007),
// whose weights are 0 or 1 here.
layout(constant_id = 1) const bool isBetween = false;  // the pixels of this dispatch

bool hasRay(ivec2 pixel) { return all(equal(pixel % room.counts.z, ivec2(0))); }

ivec2 pixelOfThread() { return isBetween ? thisPixel() : room.counts.z * thisPixel(); }

// The pixel is one of this dispatch.
bool isMine(ivec2 pixel) { return isInImage(pixel) && !(isBetween && hasRay(pixel)); }

// Pixels with rays around one between them: two, or four. i: 0 to 3; some are the same, or beyond the image.
ivec2 pixelAround(ivec2 pixel, int i) {
  ivec2 step = ivec2(room.counts.z);
  ivec2 low = pixel / step * step;
  return low + ivec2(i & 1, i >> 1) * step * ivec2(notEqual(low, pixel));
}
