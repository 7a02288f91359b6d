// The caller's camera as rays in an asset's own axes and units. All in double.
#pragma once

#include <vulkan/vulkan_core.h>
#include <glm/glm.hpp>

#include "froth/froth.h"
#include "runtime/render/view_renderer.h"
#include "shaders/gpu/layout.h"

namespace froth {

inline gpu::vec4 toFloats(const glm::dvec3& v, double w = 0) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

// gpu::kLensClass...: how the passes see through this camera.
uint32_t lensClassOf(const FrothCamera& camera);
// The direction of an orthographic camera's rays in the view's axes; unit.
glm::dvec3 parallelDirection(const FrothCamera& camera);

// Pinhole: the ray of pixel (column, row) of the region runs through the pixel's centre along origin + column stepX +
// row stepY, which points forward. Lengths are scaled so that the region's middle ray has length 1.
// Mapped: the view's axes z, x, y. Orthographic: the ray of a pixel starts at the eye plus that sum, which is
// perpendicular to `forward`.
struct CameraRays {
  glm::dvec3 origin, stepX, stepY;
  glm::dvec3 forward;         // unit view axis: gradient of clip w; of parallel rays their direction
  glm::dvec3 eye;             // relative to the asset's origin
  glm::dmat3 worldFromAsset;  // rotation
  glm::dmat3 assetFromView;   // rotation
};

// World from asset.
glm::dmat3 rotationOf(const std::array<float, 4>& quaternion);
glm::dvec3 assetFromWorld(const RenderInstance& instance, const glm::dvec3& point);

// The region is camera.scissor, resolved. Jitter moves the image by that many pixels, as it would in the
// engine's own jittered projection.
CameraRays computeCameraRays(const FrothCamera& camera, const RenderInstance& instance);

// Fills rays, view axis and lens of the block, as its class of lenses needs them.
void fillRays(const FrothCamera& camera, const CameraRays& rays, gpu::FrameBlock& block);
// Of a mapped lens: the lens of foam/lens.h, and the pixels of the region as it takes them.
void fillLens(const FrothCamera& camera, gpu::FrameBlock& block);

}  // namespace froth
