#include "runtime/render/hit_block.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/camera_rays.h"
#include "shaders/foam/lens.h"

namespace froth {
namespace {

// x -> matrix x + offset.
struct Affine {
  glm::dmat3 matrix{1};
  glm::dvec3 offset{0};
};

Affine operator*(const Affine& a, const Affine& b) { return {a.matrix * b.matrix, a.matrix * b.offset + a.offset}; }

glm::dvec3 eyeOf(const FrothCamera& camera) { return {camera.eye[0], camera.eye[1], camera.eye[2]}; }

bool hasPrevious(const FrothRenderInfo& info) { return info.previousCamera.viewport.width > 0; }

// From an eye's view axes to (x w, y w, w) of a projection, in pixels.
Affine pixelsFromView(const FrothCamera& camera) {
  const float(&clip)[16] = camera.clipFromView;
  const auto rowOf = [&](int row) { return glm::dvec4(clip[row], clip[4 + row], clip[8 + row], clip[12 + row]); };
  const VkViewport& viewport = camera.viewport;
  const glm::dvec4 w = rowOf(3);
  const glm::dvec4 x = 0.5 * viewport.width * (rowOf(0) + w) + double{viewport.x} * w;
  const glm::dvec4 y = 0.5 * viewport.height * (rowOf(1) + w) + double{viewport.y} * w;
  return {glm::transpose(glm::dmat3(glm::dvec3(x), glm::dvec3(y), glm::dvec3(w))), {x.w, y.w, w.w}};
}

// From places relative to the previous eye, in world axes, to what HitBlock::backgroundRows give.
Affine previousFromWorld(const FrothCamera& camera) {
  Affine viewFromWorld;
  for (int i = 0; i < 9; ++i) viewFromWorld.matrix[i / 3][i % 3] = camera.viewFromWorld[i];
  return camera.lens.kind == FROTH_LENS_PROJECTION ? pixelsFromView(camera) * viewFromWorld : viewFromWorld;
}

void writeRows(const Affine& map, gpu::vec4 (&rows)[3]) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rows[row][column] = static_cast<float>(map.matrix[column][row]);
    rows[row][3] = static_cast<float>(map.offset[row]);
  }
}

// How the instance moved: from a point relative to the eye to where it was, relative to the same eye.
Affine motionOf(const RenderInstance& now, const glm::dvec3& eye) {
  if (!now.previous) return {};
  const auto positionOf = [](const RenderInstance& i) {
    return glm::dvec3(i.position[0], i.position[1], i.position[2]);
  };
  const RenderInstance& before = *now.previous;
  const glm::dmat3 turn = rotationOf(before.rotation) * glm::transpose(rotationOf(now.rotation));
  const glm::dmat3 matrix = turn * (double{before.scale} / double{now.scale});
  return {matrix, matrix * (eye - positionOf(now)) + (positionOf(before) - eye)};
}

uint32_t kindOf(const FrothCamera& camera) {
  if (lensClassOf(camera) == gpu::kLensClassOrthographic) return foam::kLensOrthographic;
  return static_cast<uint32_t>(camera.lens.kind);
}

void fillPreviousLens(const FrothCamera& camera, gpu::HitBlock& block) {
  const FrothLens& lens = camera.lens;
  block.previousKind = static_cast<uint32_t>(lens.kind);
  if (lens.kind == FROTH_LENS_PROJECTION) return;
  gpu::FrameBlock taken{};
  fillLens(camera, taken);
  block.previousFirst = taken.lensFirst;
  block.previousSecond = taken.lensSecond;
  block.previousRange = taken.lensRange;
  const VkViewport& viewport = camera.viewport;
  block.previousPixels = {lens.focal[0], lens.focal[1], viewport.x + lens.centre[0],
                          std::min(viewport.y, viewport.y + viewport.height) + lens.centre[1]};
}

// The rays of the camera as a FrameBlock describes them to an instance at the world's origin.
void fillWorldRays(const FrothCamera& camera, gpu::HitBlock& block) {
  gpu::FrameBlock world{};
  fillRays(camera, computeCameraRays(camera, {}), world);
  block.rayOrigin = world.rayOrigin;
  block.rayX = world.rayX;
  block.rayY = world.rayY;
  block.forward = world.forward;
  block.lensPoint = world.lensPoint;
  block.lensFirst = world.lensFirst;
  block.lensSecond = world.lensSecond;
  block.lensRange = world.lensRange;
  block.lensKind = kindOf(camera);
}

}  // namespace

void fillHitBlock(const FrothRenderInfo& info, gpu::HitBlock& block) {
  const FrothCamera& camera = info.camera;
  const VkRect2D& region = camera.scissor;
  block.regionX = static_cast<uint32_t>(region.offset.x);
  block.regionY = static_cast<uint32_t>(region.offset.y);
  block.regionWidth = region.extent.width;
  block.regionHeight = region.extent.height;
  block.hasPrevious = hasPrevious(info);
  if (!wantsMotion(info) || !hasPrevious(info)) return;
  fillWorldRays(camera, block);
  fillPreviousLens(info.previousCamera, block);
  const Affine toPreviousEye{glm::dmat3(1), eyeOf(camera) - eyeOf(info.previousCamera)};
  writeRows(previousFromWorld(info.previousCamera) * toPreviousEye, block.backgroundRows);
  block.pixels = {static_cast<float>(region.offset.x + 0.5 - camera.jitter[0]),
                  static_cast<float>(region.offset.y + 0.5 - camera.jitter[1]), info.motionScale[0],
                  info.motionScale[1]};
}

gpu::HitInstance describeHitInstance(const FrothRenderInfo& info, const RenderInstance& instance) {
  gpu::HitInstance described{};
  described.userId = instance.userId;
  if (!hasPrevious(info)) return described;
  const glm::dvec3 eye = eyeOf(info.camera);
  const Affine toPreviousEye{glm::dmat3(1), eye - eyeOf(info.previousCamera)};
  writeRows(previousFromWorld(info.previousCamera) * toPreviousEye * motionOf(instance, eye), described.rows);
  return described;
}

}  // namespace froth
