#include "runtime/render/camera_rays.h"

#include <algorithm>

#include "shaders/foam/lens.h"

namespace froth {
namespace {

static_assert(int{FROTH_LENS_FISHEYE} == foam::kLensFisheye &&
              int{FROTH_LENS_KANNALA_BRANDT} == foam::kLensKannalaBrandt &&
              int{FROTH_LENS_RADIAL_TANGENTIAL} == foam::kLensRadialTangential &&
              int{FROTH_LENS_EQUIRECTANGULAR} == foam::kLensEquirectangular &&
              int{FROTH_LENS_RAY_MAP} == foam::kLensRayMap);

glm::dmat3 viewFromWorldOf(const FrothCamera& camera) {
  glm::dmat3 viewFromWorld;
  for (int i = 0; i < 9; ++i) viewFromWorld[i / 3][i % 3] = camera.viewFromWorld[i];
  return viewFromWorld;
}

// Of the region's first pixel, from the viewport's upper left corner.
glm::dvec2 firstPixelCentre(const FrothCamera& camera) {
  const VkViewport& viewport = camera.viewport;
  const double top = std::min(viewport.y, viewport.y + viewport.height);
  return {camera.scissor.offset.x + 0.5 - camera.jitter[0] - viewport.x,
          camera.scissor.offset.y + 0.5 - camera.jitter[1] - top};
}

void aimPinhole(const FrothCamera& camera, const glm::dmat3& assetFromView, CameraRays& rays) {
  const float* clip = camera.clipFromView;
  // Rows x, y, w of the projection: (x_ndc, y_ndc, 1) w = projection * direction, so w > 0 points forward.
  const glm::dmat3 projection(clip[0], clip[1], clip[3], clip[4], clip[5], clip[7], clip[8], clip[9], clip[11]);
  const glm::dmat3 assetFromClip = assetFromView * glm::inverse(projection);
  const VkViewport& viewport = camera.viewport;
  const VkRect2D& region = camera.scissor;
  const double left = region.offset.x + 0.5 - camera.jitter[0] - viewport.x;
  const double top = region.offset.y + 0.5 - camera.jitter[1] - viewport.y;
  rays.stepX = assetFromClip[0] * (2.0 / viewport.width);
  rays.stepY = assetFromClip[1] * (2.0 / viewport.height);
  rays.origin = assetFromClip * glm::dvec3(2.0 * left / viewport.width - 1.0, 2.0 * top / viewport.height - 1.0, 1.0);
  const glm::dvec3 middle =
      rays.origin + rays.stepX * (0.5 * region.extent.width) + rays.stepY * (0.5 * region.extent.height);
  const double scale = 1.0 / glm::length(middle);
  rays.stepX *= scale;
  rays.stepY *= scale;
  rays.origin *= scale;
  rays.forward = assetFromView * glm::normalize(glm::dvec3(clip[3], clip[7], clip[11]));
}

// x_ndc and y_ndc are linear in a point's place. The rays run where both stay, away from one who sees x to the right
// and y down.
void aimParallel(const FrothCamera& camera, const glm::dmat3& assetFromView, double scale, CameraRays& rays) {
  const float* clip = camera.clipFromView;
  const double w = clip[15];
  const glm::dvec3 alongX = glm::dvec3(clip[0], clip[4], clip[8]) / w,
                   alongY = glm::dvec3(clip[1], clip[5], clip[9]) / w;
  const glm::dvec3 normal = glm::normalize(glm::cross(alongX, alongY));
  const glm::dmat3 viewFromClip = glm::inverse(glm::transpose(glm::dmat3(alongX, alongY, normal)));
  const VkViewport& viewport = camera.viewport;
  const double left = camera.scissor.offset.x + 0.5 - camera.jitter[0] - viewport.x;
  const double top = camera.scissor.offset.y + 0.5 - camera.jitter[1] - viewport.y;
  const double x = 2.0 * left / viewport.width - 1.0 - clip[12] / w,
               y = 2.0 * top / viewport.height - 1.0 - clip[13] / w;
  const glm::dmat3 toAsset = assetFromView / scale;
  rays.stepX = toAsset * viewFromClip[0] * (2.0 / viewport.width);
  rays.stepY = toAsset * viewFromClip[1] * (2.0 / viewport.height);
  rays.origin = toAsset * (viewFromClip[0] * x + viewFromClip[1] * y);
  rays.forward = glm::normalize(glm::cross(rays.stepX, rays.stepY));
}

// The column and row of the region at which the rays' sum is shortest.
glm::dvec2 middlePixel(const CameraRays& rays) {
  const double xx = glm::dot(rays.stepX, rays.stepX), xy = glm::dot(rays.stepX, rays.stepY),
               yy = glm::dot(rays.stepY, rays.stepY);
  const double x = glm::dot(rays.origin, rays.stepX), y = glm::dot(rays.origin, rays.stepY);
  return glm::dvec2(xy * y - yy * x, xy * x - xx * y) / (xx * yy - xy * xy);
}

}  // namespace

uint32_t lensClassOf(const FrothCamera& camera) {
  if (camera.lens.kind != FROTH_LENS_PROJECTION) return gpu::kLensClassMapped;
  const float(&clip)[16] = camera.clipFromView;
  const bool isParallel = clip[3] == 0 && clip[7] == 0 && clip[11] == 0;
  return isParallel ? gpu::kLensClassOrthographic : gpu::kLensClassPinhole;
}

glm::dvec3 parallelDirection(const FrothCamera& camera) {
  CameraRays rays;
  aimParallel(camera, glm::dmat3(1), 1, rays);
  return rays.forward;
}

glm::dmat3 rotationOf(const std::array<float, 4>& quaternion) {
  const glm::dvec4 q = glm::normalize(glm::dvec4(quaternion[0], quaternion[1], quaternion[2], quaternion[3]));
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),       // column 0
          2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),       // column 1
          2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};  // column 2
}

glm::dvec3 assetFromWorld(const RenderInstance& instance, const glm::dvec3& point) {
  const glm::dvec3 position(instance.position[0], instance.position[1], instance.position[2]);
  return glm::transpose(rotationOf(instance.rotation)) * (point - position) / double{instance.scale};
}

CameraRays computeCameraRays(const FrothCamera& camera, const RenderInstance& instance) {
  CameraRays rays;
  rays.worldFromAsset = rotationOf(instance.rotation);
  rays.assetFromView = glm::transpose(rays.worldFromAsset) * glm::transpose(viewFromWorldOf(camera));
  const glm::dmat3& assetFromView = rays.assetFromView;
  const uint32_t lensClass = lensClassOf(camera);
  if (lensClass == gpu::kLensClassMapped) {
    rays.stepX = assetFromView[0];
    rays.stepY = assetFromView[1];
    rays.origin = rays.forward = assetFromView[2];
  } else if (lensClass == gpu::kLensClassOrthographic) {
    aimParallel(camera, assetFromView, instance.scale, rays);
  } else {
    aimPinhole(camera, assetFromView, rays);
  }
  rays.eye = assetFromWorld(instance, glm::dvec3(camera.eye[0], camera.eye[1], camera.eye[2]));
  return rays;
}

void fillRays(const FrothCamera& camera, const CameraRays& rays, gpu::FrameBlock& block) {
  const uint32_t lensClass = lensClassOf(camera);
  block.forward = toFloats(rays.forward);
  const glm::dvec2 middle = lensClass == gpu::kLensClassMapped ? glm::dvec2(0) : middlePixel(rays);
  if (lensClass == gpu::kLensClassOrthographic) {
    const glm::dvec3 u = glm::normalize(rays.stepX), v = glm::cross(rays.forward, u);
    const auto onPlane = [&](const glm::dvec3& step, double w) {
      return toFloats({glm::dot(step, u), glm::dot(step, v), 0}, w);
    };
    block.lensFirst = toFloats(u);
    block.lensSecond = toFloats(v);
    block.rayOrigin = toFloats(glm::dvec3(0));
    block.rayX = onPlane(rays.stepX, middle.x);
    block.rayY = onPlane(rays.stepY, middle.y);
    return;
  }
  block.rayOrigin = toFloats(rays.origin + rays.stepX * middle.x + rays.stepY * middle.y);
  block.rayX = toFloats(rays.stepX, middle.x);
  block.rayY = toFloats(rays.stepY, middle.y);
  if (lensClass == gpu::kLensClassMapped) fillLens(camera, block);
}

void fillLens(const FrothCamera& camera, gpu::FrameBlock& block) {
  const FrothLens& lens = camera.lens;
  block.lensKind = static_cast<uint32_t>(lens.kind);
  if (lens.kind == FROTH_LENS_RAY_MAP) return;
  const glm::dvec2 first = firstPixelCentre(camera);
  for (int axis = 0; axis < 2; ++axis) {
    const double focal = lens.focal[axis];
    block.lensPoint[axis] = static_cast<float>((first[axis] - lens.centre[axis]) / focal);
    block.lensPoint[axis + 2] = static_cast<float>(1 / focal);
  }
  std::copy_n(lens.coefficients, 4, block.lensFirst.begin());
  std::copy_n(lens.coefficients + 4, 4, block.lensSecond.begin());
  const auto toDouble = [](const gpu::vec4& v) { return glm::dvec4(v[0], v[1], v[2], v[3]); };
  block.lensRange =
      static_cast<float>(foam::lensRange(int{lens.kind}, toDouble(block.lensFirst), toDouble(block.lensSecond)));
}

}  // namespace froth
