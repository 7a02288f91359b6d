// Rays for one pixel in room.counts.z along each axis, and what pixels between them show: the mean of the rays around
// them, where these start on the same surface and are alike; else a ray of their own. After Kopf et al., "Joint Bilateral
// Upsampling" (2007), whose weights are 0 or 1 here.
layout(constant_id = 1) const bool isBetween = false;  // the pixels of this dispatch

const float kMostSpread = 0.1;  // of what rays around a pixel show, that it takes the mean

bool hasRay(ivec2 pixel) { return all(equal(pixel % room.counts.z, ivec2(0))); }

ivec2 pixelOfThread() { return isBetween ? thisPixel() : room.counts.z * thisPixel(); }

// The pixel is one of this dispatch.
bool isMine(ivec2 pixel) { return isInImage(pixel) && !(isBetween && hasRay(pixel)); }

struct Around {
  vec4 sum, least, most;
  int count;
  bool isWhole;  // all of them are on the same surface
};

Around nothingAround() { return Around(vec4(0.0), vec4(kFar), vec4(-kFar), 0, true); }

void addRay(vec4 shown, bool isSame, inout Around around) {
  around.sum += shown;
  around.least = min(around.least, shown);
  around.most = max(around.most, shown);
  ++around.count;
  around.isWhole = around.isWhole && isSame;
}

bool areAlike(Around around) {
  return around.isWhole && all(lessThanEqual(around.most - around.least, vec4(kMostSpread)));
}

// Pixels with rays around one between them: two, or four. i: 0 to 3; some are the same.
ivec2 pixelAround(ivec2 pixel, int i) {
  ivec2 step = ivec2(room.counts.z);
  ivec2 low = pixel / step * step;
  return low + ivec2(i & 1, i >> 1) * step * ivec2(notEqual(low, pixel));
}
