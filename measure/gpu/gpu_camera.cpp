#include "measure/gpu/gpu_camera.h"

#include <algorithm>
#include <cmath>

#include "reference/camera/view_rays.h"

namespace froth {
namespace {

static_assert(static_cast<int>(LensKind::kFisheye) == int{FROTH_LENS_FISHEYE} &&
              static_cast<int>(LensKind::kKannalaBrandt) == int{FROTH_LENS_KANNALA_BRANDT} &&
              static_cast<int>(LensKind::kRadialTangential) == int{FROTH_LENS_RADIAL_TANGENTIAL} &&
              static_cast<int>(LensKind::kEquirectangular) == int{FROTH_LENS_EQUIRECTANGULAR} &&
              static_cast<int>(LensKind::kRayMap) == int{FROTH_LENS_RAY_MAP});

FrothLens lensOf(const View& view) {
  FrothLens lens{};
  lens.kind = static_cast<FrothLensKind>(view.lens.kind);
  lens.focal[0] = static_cast<float>(view.fx);
  lens.focal[1] = static_cast<float>(view.fy);
  lens.centre[0] = static_cast<float>(view.cx);
  lens.centre[1] = static_cast<float>(view.cy);
  for (size_t i = 0; i < view.lens.distortion.size(); ++i) {
    lens.coefficients[i] = static_cast<float>(view.lens.distortion[i]);
  }
  return lens;
}

// [scene units] Of all ends of rays the farthest.
double farthestOf(const Image& ends) {
  double farthest = 0;
  for (const float end : ends.values) {
    if (std::isfinite(end)) farthest = std::max(farthest, double{end});
  }
  return farthest > 0 ? farthest : 1;
}

// View axes x right, y down, z forward are those of Vulkan's clip space; depth is reversed with an infinite far plane,
// or ends far off where rays are parallel. No output depends on it, but ends of rays are read from it: it holds those
// of a scene of any size, and the near plane is so near that what a ray meets before it does not show.
void fillProjection(const View& view, const Image* ends, FrothCamera& camera) {
  const bool isOrthographic = view.lens.kind == LensKind::kOrthographic;
  const int shift = isOrthographic ? 12 : 8;  // of the image: a share of depth, or a constant
  float(&clip)[16] = camera.clipFromView;
  clip[0] = static_cast<float>(2 * view.fx / view.width);
  clip[5] = static_cast<float>(2 * view.fy / view.height);
  clip[shift] = static_cast<float>(2 * view.cx / view.width - 1);
  clip[shift + 1] = static_cast<float>(2 * view.cy / view.height - 1);
  const double farthest = ends ? farthestOf(*ends) : 1e4;
  clip[isOrthographic ? 10 : 14] =
      static_cast<float>(isOrthographic ? 0.5 / farthest : std::max(1e-31 * farthest, 1e-35));
  clip[isOrthographic ? 15 : 11] = 1.0f;
}

// Far behind parallel rays lies the point that sees all of them along themselves: so far that nothing of a scene shifts
// it.
constexpr float kParallelApex = 1e15f;

}  // namespace

std::vector<float> sceneDepthOf(const View& view, const Image& distances) {
  if (lensClassesOf(view) == FROTH_LENS_CLASS_MAPPED) return distances.values;
  const FrothCamera camera = cameraOf(view, &distances);
  const float(&clip)[16] = camera.clipFromView;
  const ViewRays rays(view);
  std::vector<float> depths;
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const double t = *distances.pixel(x, y), cosine = glm::dot(rays.ofPixel(x, y)->direction, forwardOf(view));
      const double ahead = std::max(t * cosine, double{clip[14]});  // what lies before the near plane is on it
      const double depth = (clip[10] * ahead + clip[14]) / (clip[11] * ahead + clip[15]);
      depths.push_back(static_cast<float>(std::isinf(t) ? (clip[15] > 0 ? 1 : 0) : depth));
    }
  }
  return depths;
}

uint32_t lensClassesOf(const View& view) {
  if (view.lens.kind == LensKind::kPinhole) return 0;
  return view.lens.kind == LensKind::kOrthographic ? FROTH_LENS_CLASS_ORTHOGRAPHIC : FROTH_LENS_CLASS_MAPPED;
}

uint32_t lensClassesOf(const std::vector<SelectedView>& views) {
  uint32_t classes = 0;
  for (const SelectedView& selected : views) classes |= lensClassesOf(selected.view);
  return classes;
}

FrothCamera cameraOf(const View& view, const Image* ends) {
  FrothCamera camera{};
  const auto& world = view.worldFromCamera;
  for (int axis = 0; axis < 3; ++axis) {
    camera.eye[axis] = world[axis * 4 + 3];
    // The inverse of a rotation is its transpose: row `axis` of world-from-camera is column `axis` of the
    // inverse.
    for (int row = 0; row < 3; ++row) camera.viewFromWorld[axis * 3 + row] = static_cast<float>(world[axis * 4 + row]);
  }
  camera.viewport = {0, 0, static_cast<float>(view.width), static_cast<float>(view.height), 0, 1};
  if (lensClassesOf(view) == FROTH_LENS_CLASS_MAPPED) {
    camera.lens = lensOf(view);
  } else {
    fillProjection(view, ends, camera);
  }
  return camera;
}

FrothGpuRay gpuRayOf(const View& view, const ViewRay& ray, float end) {
  FrothGpuRay gpuRay{};
  gpuRay.tMax = end;
  for (int axis = 0; axis < 3; ++axis) {
    gpuRay.origin[axis] = static_cast<float>(ray.offset[axis]);
    gpuRay.direction[axis] = static_cast<float>(ray.direction[axis]);
  }
  if (view.lens.kind == LensKind::kOrthographic) gpuRay.apex = kParallelApex;
  return gpuRay;
}

}  // namespace froth
