#include "runtime/render/device_depth.h"

#include <limits>

namespace froth {
namespace {

glm::dvec4 rowOf(const FrothCamera& camera, int row) {
  const float(&clip)[16] = camera.clipFromView;
  return {clip[row], clip[4 + row], clip[8 + row], clip[12 + row]};
}

// The sign of the change of z / w with distance, along a ray on which w grows or stays: d(z / w) = (dz w - z dw) / w^2,
// which has one sign everywhere on a line.
double depthGrowth(const FrothCamera& camera) {
  const glm::dvec4 z = rowOf(camera, 2), w = rowOf(camera, 3);
  const glm::dvec3 axis = lensClassOf(camera) == gpu::kLensClassPinhole ? glm::dvec3(w) : parallelDirection(camera);
  return glm::dot(glm::dvec3(z), axis) * w.w - z.w * glm::dot(glm::dvec3(w), axis);
}

}  // namespace

bool isDepthReversed(const FrothCamera& camera) {
  const double growth = depthGrowth(camera);
  return lensClassOf(camera) == gpu::kLensClassPinhole ? growth < 0 : growth * rowOf(camera, 3).w < 0;
}

bool hasDepth(const FrothCamera& camera) {
  return depthGrowth(camera) != 0 && camera.viewport.minDepth != camera.viewport.maxDepth;
}

void fillDepthRange(const FrothCamera& camera, gpu::FrameBlock& block) {
  const VkViewport& viewport = camera.viewport;
  if (lensClassOf(camera) == gpu::kLensClassMapped) {
    block.depthRange = {0, 1, 1, std::numeric_limits<float>::infinity()};
    return;
  }
  const bool isReversed = isDepthReversed(camera);
  block.depthRange = {viewport.minDepth, viewport.maxDepth, isReversed ? 0.0f : 1.0f,
                      isReversed ? viewport.minDepth : viewport.maxDepth};
}

void fillDepthRows(const FrothCamera& camera, const CameraRays& rays, float scale, gpu::FrameBlock& block) {
  const glm::dvec4 z = rowOf(camera, 2), w = rowOf(camera, 3);
  block.depthRow = toFloats(rays.assetFromView * glm::dvec3(z) * double{scale}, z.w);
  block.depthScale = toFloats(rays.assetFromView * glm::dvec3(w) * double{scale}, w.w);
}

}  // namespace froth
