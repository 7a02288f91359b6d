#include "runtime/context/render_info.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/context/camera_checks.h"
#include "runtime/context/image_checks.h"
#include "runtime/context/info_checks.h"
#include "runtime/context/walk_limits.h"
#include "runtime/render/device_depth.h"
#include "runtime/render/frame_images.h"

namespace froth {
namespace {

constexpr float kDefaultDepthQuantile = 0.5f;
constexpr uint32_t kDefaultMaxEntries = 16384;

FrothResult checkLensClass(const Messages& messages, const char* call, const FrothCamera& camera,
                           uint32_t lensClasses) {
  const uint32_t lensClass = lensClassOf(camera);
  if (lensClass == gpu::kLensClassPinhole || (lensClasses >> (lensClass - 1) & 1) != 0) {
    return FROTH_OK;
  }
  return messages.fail(
      FROTH_ERROR_UNSUPPORTED, call,
      "camera: %s, which the view was not made for; set %s in FrothViewInfo::lensClasses and "
      "FrothContextInfo::lensClasses",
      lensClass == gpu::kLensClassMapped ? "a lens that is no projection" : "parallel rays",
      lensClass == gpu::kLensClassMapped ? "FROTH_LENS_CLASS_MAPPED" : "FROTH_LENS_CLASS_ORTHOGRAPHIC");
}

// The pixels that viewport and scissor let through; may be empty.
VkRect2D drawnRectangle(const FrothCamera& camera) {
  const VkViewport& viewport = camera.viewport;
  const double bottom = double{viewport.y} + viewport.height;
  double x0 = std::floor(viewport.x), x1 = std::ceil(double{viewport.x} + viewport.width);
  double y0 = std::floor(std::min<double>(viewport.y, bottom)), y1 = std::ceil(std::max<double>(viewport.y, bottom));
  const VkRect2D& scissor = camera.scissor;
  if (scissor.extent.width != 0 || scissor.extent.height != 0) {
    x0 = std::max<double>(x0, scissor.offset.x);
    y0 = std::max<double>(y0, scissor.offset.y);
    x1 = std::min(x1, static_cast<double>(scissor.extent.width) + scissor.offset.x);
    y1 = std::min(y1, static_cast<double>(scissor.extent.height) + scissor.offset.y);
  }
  constexpr double kFarthest = 1 << 20;  // beyond any extent, within int32
  x0 = std::clamp(x0, -kFarthest, kFarthest);
  y0 = std::clamp(y0, -kFarthest, kFarthest);
  x1 = std::clamp(x1, x0, kFarthest);
  y1 = std::clamp(y1, y0, kFarthest);
  return {{static_cast<int32_t>(x0), static_cast<int32_t>(y0)},
          {static_cast<uint32_t>(x1 - x0), static_cast<uint32_t>(y1 - y0)}};
}

// Of images alone; what they ask of the camera follows.
FrothResult checkImages(const Messages& messages, const char* call, const FrothRenderInfo& info,
                        const VkRect2D& drawn) {
  for (const FrameImage& image : kFrameImages) {
    const FrothImage& given = image.of(info);
    const FrothResult result = checkImage(messages, call, image.name, given, image.formats, image.formatNames, drawn);
    if (result != FROTH_OK) return result;
  }
  if (info.camera.lens.kind == FROTH_LENS_RAY_MAP && !info.camera.lens.rayMap.image) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.lens.rayMap: null; give the image of directions");
  }
  if (hasRole(info, ImageRole::kDrawn) || hasRole(info, ImageRole::kOfHits)) return FROTH_OK;
  std::string names;
  for (const FrameImage& image : kFrameImages) {
    if (image.role != ImageRole::kRead) names += (names.empty() ? "" : ", ") + std::string(image.name);
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: all null; at least one is needed", names.c_str());
}

FrothResult checkDepths(const Messages& messages, const char* call, const FrothRenderInfo& info) {
  const bool isAsked = info.depth.image || info.sceneDepth.image;
  if (!isAsked || info.camera.lens.kind != FROTH_LENS_PROJECTION || hasDepth(info.camera)) {
    return FROTH_OK;
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call,
                       "camera: clipFromView has no depth that changes with distance, or viewport.minDepth equals "
                       "maxDepth (%g); depth and sceneDepth need both",
                       double{info.camera.viewport.minDepth});
}

// The camera of the frame before, with its defaults resolved.
FrothResult resolveMotion(const Messages& messages, const char* call, FrothRenderInfo& info) {
  if (!wantsMotion(info)) {
    return FROTH_OK;
  }
  FrothCamera& previous = info.previousCamera;
  if (info.camera.lens.kind == FROTH_LENS_RAY_MAP || previous.lens.kind == FROTH_LENS_RAY_MAP) {
    return messages.fail(
        FROTH_ERROR_UNSUPPORTED, call,
        "motion, reactive: with a ray map, from which no formula leads back to a pixel; leave these images out");
  }
  for (float& scale : info.motionScale) {
    if (!std::isfinite(scale)) {
      return messages.fail(FROTH_ERROR_ARGUMENT, call, "motionScale: %g; must be finite", double{scale});
    }
    scale = scale == 0 ? 1 : scale;
  }
  if (previous.viewport.width == 0) {
    return FROTH_OK;
  }
  resolveLens(previous);
  return checkCamera(messages, (std::string(call) + ", previousCamera").c_str(), previous);
}

FrothResult checkDrawn(const Messages& messages, const char* call, VkExtent2D maxExtent, const VkRect2D& drawn) {
  if (drawn.extent.width == 0 || drawn.extent.height == 0 || drawn.offset.x < 0 || drawn.offset.y < 0) {
    return messages.fail(
        FROTH_ERROR_ARGUMENT, call,
        "camera: viewport and scissor leave %u x %u pixels at (%d, %d); at least one at an offset >= 0 is "
        "needed; cut what lies outside of the images with the scissor",
        drawn.extent.width, drawn.extent.height, drawn.offset.x, drawn.offset.y);
  }
  if (drawn.extent.width > maxExtent.width || drawn.extent.height > maxExtent.height) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "camera: %u x %u pixels, but the view was made for %u x %u; raise FrothViewInfo::maxExtent",
                         drawn.extent.width, drawn.extent.height, maxExtent.width, maxExtent.height);
  }
  return FROTH_OK;
}

FrothResult checkToneCurve(const Messages& messages, const char* call, const FrothRenderInfo& info) {
  const auto curve = static_cast<int32_t>(info.toneCurve);
  if (curve < 0 || curve > FROTH_TONE_KHRONOS_NEUTRAL) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "toneCurve: %d; must be a FrothToneCurve", curve);
  }
  if (curve != FROTH_TONE_NONE && info.displayCoded) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "toneCurve: %d with displayCoded; a display-coded image is the capture; set one of them",
                         curve);
  }
  return FROTH_OK;
}

FrothResult checkTileForm(const Messages& messages, const char* call, const FrothRenderInfo& info) {
  const auto form = static_cast<int32_t>(info.tileForm);
  if (form >= 0 && form <= FROTH_TILE_FORM_ALL_LONG) return FROTH_OK;
  return messages.fail(FROTH_ERROR_ARGUMENT, call, "tileForm: %d; must be a FrothTileForm", form);
}

// NaN fails every comparison, so each condition says what is right.
FrothResult resolveLimits(const Messages& messages, const char* call, FrothRenderInfo& info) {
  info.cutoff = info.cutoff == 0 ? kDefaultCutoff : info.cutoff < 0 ? 0 : info.cutoff;
  info.quantile = info.quantile == 0 ? kDefaultDepthQuantile : info.quantile;
  resolveWalkLimits(info.maxSteps, info.maxNeighbours);
  info.maxEntries = info.maxEntries == 0 ? kDefaultMaxEntries : info.maxEntries;
  info.mask = info.mask == 0 ? ~0u : info.mask;
  if (!(info.cutoff < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "cutoff: %g; must be below 1", double{info.cutoff});
  }
  if (!(info.quantile > 0 && info.quantile < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "quantile: %g; must lie between 0 and 1", double{info.quantile});
  }
  for (const float limit : {info.nearRatio, info.nearDepth}) {
    if (limit != FROTH_NEAR_DEFAULT && !(limit >= 0 && std::isfinite(limit))) {
      return messages.fail(FROTH_ERROR_ARGUMENT, call,
                           "nearRatio, nearDepth: %g; must be 0, positive, or FROTH_NEAR_DEFAULT", double{limit});
    }
  }
  return FROTH_OK;
}

}  // namespace

FrothResult resolveRenderInfo(const Messages& messages, const char* call, VkExtent2D maxExtent, uint32_t lensClasses,
                              FrothRenderInfo& info) {
  resolveLens(info.camera);
  if (const FrothResult result = checkCamera(messages, call, info.camera); result != FROTH_OK) {
    return result;
  }
  if (const FrothResult result = checkLensClass(messages, call, info.camera, lensClasses); result != FROTH_OK) {
    return result;
  }
  const VkRect2D drawn = drawnRectangle(info.camera);
  if (const FrothResult result = checkDrawn(messages, call, maxExtent, drawn); result != FROTH_OK) {
    return result;
  }
  info.camera.scissor = drawn;
  FrothResult result = checkImages(messages, call, info, drawn);
  if (result == FROTH_OK) result = checkDepths(messages, call, info);
  if (result == FROTH_OK) result = resolveMotion(messages, call, info);
  if (result == FROTH_OK) result = checkToneCurve(messages, call, info);
  if (result == FROTH_OK) result = checkTileForm(messages, call, info);
  return result == FROTH_OK ? resolveLimits(messages, call, info) : result;
}

void resolveNearLimits(const FrothRenderInfo& info, RenderInstance& instance) {
  const GpuAsset& asset = *instance.asset;
  instance.nearRatio = info.nearRatio == FROTH_NEAR_DEFAULT ? asset.nearRatio : info.nearRatio;
  instance.nearDepth = info.nearDepth == FROTH_NEAR_DEFAULT ? asset.nearDepth * instance.scale : info.nearDepth;
  const FrothLensKind lens = info.camera.lens.kind;
  const bool isParallel = lensClassOf(info.camera) == gpu::kLensClassOrthographic;
  if (isParallel || (lens != FROTH_LENS_PROJECTION && lens != FROTH_LENS_RADIAL_TANGENTIAL)) {
    instance.nearDepth = 0;
  }
  if (isParallel) {
    instance.nearRatio = 0;
  }
}

}  // namespace froth
