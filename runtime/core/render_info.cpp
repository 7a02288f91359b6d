#include "runtime/core/render_info.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>

#include "runtime/render/device_depth.h"

namespace froth {
namespace {

constexpr float kDefaultCutoff = 1e-3f;
constexpr float kDefaultDepthQuantile = 0.5f;
constexpr uint32_t kDefaultMaxSteps = 65536;

// Float matrices that an engine multiplied together drift by about 1e-6; 1e-3 catches scales and swapped
// rows.
constexpr double kOrthonormalTolerance = 1e-3;

double determinantOf(const double (&rows)[3][4]) {  // of their first three columns
  return rows[0][0] * (rows[1][1] * rows[2][2] - rows[1][2] * rows[2][1]) -
         rows[0][1] * (rows[1][0] * rows[2][2] - rows[1][2] * rows[2][0]) +
         rows[0][2] * (rows[1][0] * rows[2][1] - rows[1][1] * rows[2][0]);
}

bool isOrthonormal(const float (&m)[9]) {
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      const double product = double{m[3 * a]} * m[3 * b] + double{m[3 * a + 1]} * m[3 * b + 1] +
                             double{m[3 * a + 2]} * m[3 * b + 2];
      if (std::abs(product - (a == b ? 1.0 : 0.0)) > kOrthonormalTolerance) {
        return false;
      }
    }
  }
  return true;
}

// An orthographic projection: rows x and y must tell pixels apart.
FrothResult checkParallel(const Messages& messages, const char* call, const double (&rows)[3][4]) {
  if (rows[2][3] < 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.clipFromView: its row w is (0, 0, 0, %g); must be above 0",
                         rows[2][3]);
  }
  const double normal[3] = {rows[0][1] * rows[1][2] - rows[0][2] * rows[1][1],
                            rows[0][2] * rows[1][0] - rows[0][0] * rows[1][2],
                            rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]};
  const double area = std::hypot(normal[0], normal[1], normal[2]);
  const double lengths =
      std::hypot(rows[0][0], rows[0][1], rows[0][2]) * std::hypot(rows[1][0], rows[1][1], rows[1][2]);
  if (!(area > 1e-6 * lengths)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "camera.clipFromView: its rows x, y have the cross product %g: no parallel rays follow from them",
                         area);
  }
  return FROTH_OK;
}

// Rows x, y and w of the projection give the rays: with the eye at the view's origin their constant parts are
// zero.
FrothResult checkProjection(const Messages& messages, const char* call, const float (&clipFromView)[16]) {
  double rows[3][4];
  const int rowIndices[3] = {0, 1, 3};
  double lengths[3];
  for (int r = 0; r < 3; ++r) {
    for (int column = 0; column < 4; ++column) {
      rows[r][column] = clipFromView[4 * column + rowIndices[r]];
    }
    lengths[r] = std::hypot(rows[r][0], rows[r][1], rows[r][2]);
  }
  if (lengths[2] == 0 && rows[2][3] != 0) {
    return checkParallel(messages, call, rows);
  }
  const double determinant = determinantOf(rows);
  // Relative to the rows' lengths this is the volume of three unit vectors; floats resolve it to about 1e-7.
  if (!(std::abs(determinant) > 1e-6 * lengths[0] * lengths[1] * lengths[2])) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "camera.clipFromView: its rows x, y, w have determinant %g: no rays follow from it",
                         determinant);
  }
  for (int r = 0; r < 3; ++r) {
    if (std::abs(rows[r][3]) > 1e-6 * lengths[r]) {
      return messages.fail(
          FROTH_ERROR_ARGUMENT, call,
          "camera.clipFromView: row %d has the constant part %g; move the eye into camera.eye", rowIndices[r],
          rows[r][3]);
    }
  }
  return FROTH_OK;
}

// Sends a message that names the first value that is not finite.
template <class T>
FrothResult checkFinite(const Messages& messages, const char* call, const char* field,
                        std::span<const T> values) {
  const auto bad = std::find_if(values.begin(), values.end(), [](T value) { return !std::isfinite(value); });
  if (bad == values.end()) {
    return FROTH_OK;
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.%s: element %td is %g; must be finite", field,
                       bad - values.begin(), double{*bad});
}

FrothResult checkRotation(const Messages& messages, const char* call, const float (&m)[9]) {
  if (!isOrthonormal(m)) {
    return messages.fail(
        FROTH_ERROR_ARGUMENT, call,
        "camera.viewFromWorld: not a rotation within %g; normalize it, and keep scale out of it",
        kOrthonormalTolerance);
  }
  const double columns[3][4] = {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
  if (determinantOf(columns) < 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "camera.viewFromWorld: a reflection; put the flip of an axis into clipFromView");
  }
  return FROTH_OK;
}

FrothResult checkLens(const Messages& messages, const char* call, const FrothCamera& camera) {
  const FrothLens& lens = camera.lens;
  const auto kind = static_cast<int32_t>(lens.kind);
  if (kind < 0 || kind > FROTH_LENS_RAY_MAP) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.lens.kind: %d; must be a FrothLensKind",
                         kind);
  }
  if (lens.kind == FROTH_LENS_RAY_MAP) {
    const float (&jitter)[2] = camera.jitter;
    if (jitter[0] == 0 && jitter[1] == 0) {
      return FROTH_OK;
    }
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "camera.jitter: (%g, %g) with a ray map; must be 0; jitter the directions of the map",
                         double{jitter[0]}, double{jitter[1]});
  }
  FrothResult result = checkFinite<float>(messages, call, "lens.centre", lens.centre);
  if (result == FROTH_OK) {
    result = checkFinite<float>(messages, call, "lens.coefficients", lens.coefficients);
  }
  if (result != FROTH_OK) {
    return result;
  }
  for (const float focal : lens.focal) {
    if (!(focal > 0 && std::isfinite(focal))) {
      return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.lens.focal: %g; must be above 0, in pixels",
                           double{focal});
    }
  }
  return FROTH_OK;
}

// The defaults of a lens, and null for what it has no use for.
void resolveLens(FrothCamera& camera) {
  FrothLens& lens = camera.lens;
  if (lens.kind != FROTH_LENS_RAY_MAP) {
    lens.rayMap = {};
  }
  if (lens.kind == FROTH_LENS_EQUIRECTANGULAR && lens.focal[0] == 0 && lens.focal[1] == 0) {
    constexpr double kPi = 3.14159265358979323846;
    const double width = camera.viewport.width, height = std::abs(camera.viewport.height);
    lens.focal[0] = static_cast<float>(width / (2 * kPi));
    lens.focal[1] = static_cast<float>(height / kPi);
    lens.centre[0] = static_cast<float>(0.5 * width);
    lens.centre[1] = static_cast<float>(0.5 * height);
  }
}

FrothResult checkLensClass(const Messages& messages, const char* call, const FrothCamera& camera,
                           uint32_t lensClasses) {
  const uint32_t lensClass = lensClassOf(camera);
  if (lensClass == gpu::kLensClassPinhole || (lensClasses >> (lensClass - 1) & 1) != 0) {
    return FROTH_OK;
  }
  return messages.fail(FROTH_ERROR_UNSUPPORTED, call,
                       "camera: %s, which the view was not made for; set %s in FrothViewInfo::lensClasses and "
                       "FrothContextInfo::lensClasses",
                       lensClass == gpu::kLensClassMapped ? "a lens that is no projection" : "parallel rays",
                       lensClass == gpu::kLensClassMapped ? "FROTH_LENS_CLASS_MAPPED"
                                                          : "FROTH_LENS_CLASS_ORTHOGRAPHIC");
}

FrothResult checkCamera(const Messages& messages, const char* call, const FrothCamera& camera) {
  const VkViewport& viewport = camera.viewport;
  const float viewportValues[] = {viewport.x, viewport.y, viewport.width, viewport.height};
  FrothResult result = checkFinite<double>(messages, call, "eye", camera.eye);
  const auto check = [&](const char* field, std::span<const float> values) {
    result = result == FROTH_OK ? checkFinite(messages, call, field, values) : result;
  };
  check("viewFromWorld", camera.viewFromWorld);
  check("clipFromView", camera.clipFromView);
  check("jitter", camera.jitter);
  check("viewport", viewportValues);
  if (result == FROTH_OK) {
    result = checkRotation(messages, call, camera.viewFromWorld);
  }
  if (result != FROTH_OK) {
    return result;
  }
  if (viewport.width <= 0 || viewport.height == 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "camera.viewport: %g x %g; width > 0 and height != 0 are needed",
                         double{viewport.width}, double{viewport.height});
  }
  return camera.lens.kind == FROTH_LENS_PROJECTION ? checkProjection(messages, call, camera.clipFromView)
                                                   : checkLens(messages, call, camera);
}

// The pixels that viewport and scissor let through; may be empty.
VkRect2D drawnRectangle(const FrothCamera& camera) {
  const VkViewport& viewport = camera.viewport;
  const double bottom = double{viewport.y} + viewport.height;
  double x0 = std::floor(viewport.x), x1 = std::ceil(double{viewport.x} + viewport.width);
  double y0 = std::floor(std::min<double>(viewport.y, bottom)),
         y1 = std::ceil(std::max<double>(viewport.y, bottom));
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

FrothResult checkImage(const Messages& messages, const char* call, const char* name, const FrothImage& image,
                       std::initializer_list<VkFormat> formats, const char* formatNames,
                       const VkRect2D& drawn) {
  if (!image.image) {
    return FROTH_OK;
  }
  if (!image.view) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s.view: null; give a 2D view of the image", name);
  }
  if (image.samples > VK_SAMPLE_COUNT_1_BIT) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, call,
                         "%s.samples: %d; one sample per pixel is needed; resolve the image first, depth with "
                         "VK_RESOLVE_MODE_MIN_BIT or VK_RESOLVE_MODE_MAX_BIT",
                         name, image.samples);
  }
  if (std::find(formats.begin(), formats.end(), image.format) == formats.end()) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s.format: VkFormat %d; must be %s", name, image.format,
                         formatNames);
  }
  if (image.layoutOut == VK_IMAGE_LAYOUT_UNDEFINED || image.layoutOut == VK_IMAGE_LAYOUT_PREINITIALIZED) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "%s.layoutOut: VkImageLayout %d; name the layout of its next use", name,
                         image.layoutOut);
  }
  const uint64_t right = uint64_t{drawn.extent.width} + static_cast<uint32_t>(drawn.offset.x);
  const uint64_t bottom = uint64_t{drawn.extent.height} + static_cast<uint32_t>(drawn.offset.y);
  if (right > image.extent.width || bottom > image.extent.height) {
    return messages.fail(
        FROTH_ERROR_ARGUMENT, call,
        "%s.extent: %u x %u, but viewport and scissor reach to %llu x %llu; clip them to the image", name,
        image.extent.width, image.extent.height, static_cast<unsigned long long>(right),
        static_cast<unsigned long long>(bottom));
  }
  return FROTH_OK;
}

FrothResult checkRayMap(const Messages& messages, const char* call, const FrothImage& image,
                        const VkRect2D& drawn) {
  if (!image.image) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.lens.rayMap: null; give the image of directions");
  }
  return checkImage(messages, call, "camera.lens.rayMap", image, {VK_FORMAT_R32G32B32A32_SFLOAT},
                    "R32G32B32A32_SFLOAT", drawn);
}

FrothResult checkDepths(const Messages& messages, const char* call, const FrothRenderInfo& info,
                        const VkRect2D& drawn) {
  FrothResult result = checkImage(messages, call, "depth", info.depth, {VK_FORMAT_R32_SFLOAT}, "R32_SFLOAT", drawn);
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "sceneDepth", info.sceneDepth,
                        {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT,
                         VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D16_UNORM, VK_FORMAT_R32_SFLOAT},
                        "D32_SFLOAT, D32_SFLOAT_S8_UINT, D24_UNORM_S8_UINT, X8_D24_UNORM_PACK32, D16_UNORM or "
                        "R32_SFLOAT",
                        drawn);
  }
  const bool isAsked = info.depth.image || info.sceneDepth.image;
  if (result != FROTH_OK || !isAsked || info.camera.lens.kind != FROTH_LENS_PROJECTION || hasDepth(info.camera)) {
    return result;
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call,
                       "camera: clipFromView has no depth that changes with distance, or viewport.minDepth equals "
                       "maxDepth (%g); depth and sceneDepth need both",
                       double{info.camera.viewport.minDepth});
}

FrothResult checkDrawn(const Messages& messages, const char* call, VkExtent2D maxExtent,
                       const VkRect2D& drawn) {
  if (drawn.extent.width == 0 || drawn.extent.height == 0 || drawn.offset.x < 0 || drawn.offset.y < 0) {
    return messages.fail(
        FROTH_ERROR_ARGUMENT, call,
        "camera: viewport and scissor leave %u x %u pixels at (%d, %d); at least one at an offset >= 0 is "
        "needed; cut what lies outside of the images with the scissor",
        drawn.extent.width, drawn.extent.height, drawn.offset.x, drawn.offset.y);
  }
  if (drawn.extent.width > maxExtent.width || drawn.extent.height > maxExtent.height) {
    return messages.fail(
        FROTH_ERROR_ARGUMENT, call,
        "camera: %u x %u pixels, but the view was made for %u x %u; raise FrothViewInfo::maxExtent",
        drawn.extent.width, drawn.extent.height, maxExtent.width, maxExtent.height);
  }
  return FROTH_OK;
}

// NaN fails every comparison, so each condition says what is right.
FrothResult resolveLimits(const Messages& messages, const char* call, FrothRenderInfo& info) {
  info.cutoff = info.cutoff == 0 ? kDefaultCutoff : info.cutoff < 0 ? 0 : info.cutoff;
  info.depthQuantile = info.depthQuantile == 0 ? kDefaultDepthQuantile : info.depthQuantile;
  info.maxSteps = info.maxSteps == 0 ? kDefaultMaxSteps : info.maxSteps;
  info.mask = info.mask == 0 ? ~0u : info.mask;
  if (!(info.cutoff < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "cutoff: %g; must be below 1", double{info.cutoff});
  }
  if (!(info.depthQuantile > 0 && info.depthQuantile < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "depthQuantile: %g; must lie between 0 and 1",
                         double{info.depthQuantile});
  }
  for (const float limit : {info.nearRatio, info.nearDepth}) {
    if (limit != FROTH_NEAR_DEFAULT && !(limit >= 0 && std::isfinite(limit))) {
      return messages.fail(FROTH_ERROR_ARGUMENT, call,
                           "nearRatio, nearDepth: %g; must be 0, positive, or FROTH_NEAR_DEFAULT",
                           double{limit});
    }
  }
  return FROTH_OK;
}

}  // namespace

FrothResult resolveRenderInfo(const Messages& messages, const char* call, VkExtent2D maxExtent,
                              uint32_t lensClasses, FrothRenderInfo& info) {
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
  FrothResult result = checkImage(messages, call, "colour", info.colour,
                                  {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT},
                                  "R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT", drawn);
  if (result == FROTH_OK) {
    result =
        checkImage(messages, call, "distance", info.distance, {VK_FORMAT_R32_SFLOAT}, "R32_SFLOAT", drawn);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "normal", info.normal, {VK_FORMAT_R16G16B16A16_SFLOAT},
                        "R16G16B16A16_SFLOAT", drawn);
  }
  if (result == FROTH_OK) {
    result = checkDepths(messages, call, info, drawn);
  }
  const bool isMap = info.camera.lens.kind == FROTH_LENS_RAY_MAP;
  if (result == FROTH_OK && isMap) {
    result = checkRayMap(messages, call, info.camera.lens.rayMap, drawn);
  }
  if (result != FROTH_OK) {
    return result;
  }
  if (!info.colour.image && !info.distance.image && !info.normal.image) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "colour, distance, normal: all null; at least one is needed");
  }
  return resolveLimits(messages, call, info);
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
