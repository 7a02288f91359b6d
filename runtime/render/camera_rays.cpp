#include "runtime/render/camera_rays.h"

namespace froth {
namespace {

glm::dmat3 rotationOf(const std::array<float, 4>& quaternion) {
  const glm::dvec4 q = glm::normalize(glm::dvec4(quaternion[0], quaternion[1], quaternion[2], quaternion[3]));
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),       // column 0
          2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),       // column 1
          2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};  // column 2
}

}  // namespace

CameraRays computeCameraRays(const FrothCamera& camera, const RenderInstance& instance) {
  const float* clip = camera.clipFromView;
  // Rows x, y, w of the projection: (x_ndc, y_ndc, 1) w = projection * direction, so w > 0 points forward.
  const glm::dmat3 projection(clip[0], clip[1], clip[3], clip[4], clip[5], clip[7], clip[8], clip[9],
                              clip[11]);
  glm::dmat3 viewFromWorld;
  for (int i = 0; i < 9; ++i) viewFromWorld[i / 3][i % 3] = camera.viewFromWorld[i];
  CameraRays rays;
  rays.worldFromAsset = rotationOf(instance.rotation);
  const glm::dmat3 assetFromView = glm::transpose(rays.worldFromAsset) * glm::transpose(viewFromWorld);
  const glm::dmat3 assetFromClip = assetFromView * glm::inverse(projection);

  const VkViewport& viewport = camera.viewport;
  const VkRect2D& region = camera.scissor;
  const double left = region.offset.x + 0.5 - camera.jitter[0] - viewport.x;
  const double top = region.offset.y + 0.5 - camera.jitter[1] - viewport.y;
  rays.stepX = assetFromClip[0] * (2.0 / viewport.width);
  rays.stepY = assetFromClip[1] * (2.0 / viewport.height);
  rays.origin =
      assetFromClip * glm::dvec3(2.0 * left / viewport.width - 1.0, 2.0 * top / viewport.height - 1.0, 1.0);
  const glm::dvec3 middle =
      rays.origin + rays.stepX * (0.5 * region.extent.width) + rays.stepY * (0.5 * region.extent.height);
  const double scale = 1.0 / glm::length(middle);
  rays.stepX *= scale;
  rays.stepY *= scale;
  rays.origin *= scale;

  rays.forward = assetFromView * glm::normalize(glm::dvec3(clip[3], clip[7], clip[11]));
  const glm::dvec3 eye(camera.eye[0], camera.eye[1], camera.eye[2]);
  const glm::dvec3 position(instance.position[0], instance.position[1], instance.position[2]);
  rays.eye = glm::transpose(rays.worldFromAsset) * (eye - position) / double{instance.scale};
  return rays;
}

}  // namespace froth
