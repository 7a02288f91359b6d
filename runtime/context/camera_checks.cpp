#include "runtime/context/camera_checks.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "runtime/context/image_checks.h"
#include "runtime/render/camera_rays.h"

namespace froth {
namespace {

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
      const double product =
          double{m[3 * a]} * m[3 * b] + double{m[3 * a + 1]} * m[3 * b + 1] + double{m[3 * a + 2]} * m[3 * b + 2];
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
    return messages.fail(
        FROTH_ERROR_ARGUMENT, call,
        "camera.clipFromView: its rows x, y have the cross product %g: no parallel rays follow from them", area);
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
      return messages.fail(FROTH_ERROR_ARGUMENT, call,
                           "camera.clipFromView: row %d has the constant part %g; move the eye into camera.eye",
                           rowIndices[r], rows[r][3]);
    }
  }
  return FROTH_OK;
}

// Sends a message that names the first value that is not finite.
template <class T>
FrothResult checkFinite(const Messages& messages, const char* call, const char* field, std::span<const T> values) {
  const auto bad = std::find_if(values.begin(), values.end(), [](T value) { return !std::isfinite(value); });
  if (bad == values.end()) {
    return FROTH_OK;
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.%s: element %td is %g; must be finite", field,
                       bad - values.begin(), double{*bad});
}

FrothResult checkRotation(const Messages& messages, const char* call, const float (&m)[9]) {
  if (!isOrthonormal(m)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
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
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.lens.kind: %d; must be a FrothLensKind", kind);
  }
  if (lens.kind == FROTH_LENS_RAY_MAP) {
    const float(&jitter)[2] = camera.jitter;
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

}  // namespace

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

FrothResult checkCamera(const Messages& messages, const char* call, const FrothCamera& camera) {
  const VkViewport& viewport = camera.viewport;
  const float viewportValues[] = {viewport.x, viewport.y, viewport.width, viewport.height};
  FrothResult result = checkExtension(messages, call, "camera", camera.extension);
  if (result == FROTH_OK) {
    result = checkExtension(messages, call, "camera.lens", camera.lens.extension);
  }
  if (result == FROTH_OK) {
    result = checkFinite<double>(messages, call, "eye", camera.eye);
  }
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
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "camera.viewport: %g x %g; width > 0 and height != 0 are needed",
                         double{viewport.width}, double{viewport.height});
  }
  return camera.lens.kind == FROTH_LENS_PROJECTION ? checkProjection(messages, call, camera.clipFromView)
                                                   : checkLens(messages, call, camera);
}

}  // namespace froth
