// Views as cameras.json describes them (docs/CAMERAS.md).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace froth {

struct RayMap;  // ray_map.h

// How an image sees; the formulas are in shaders/foam/lens.h, whose numbers these are.
enum class LensKind : int {
  kPinhole,
  kFisheye,           // equidistant
  kKannalaBrandt,     // k1, k2, k3, k4 of OpenCV's fisheye
  kRadialTangential,  // k1, k2, p1, p2 [, k3 [, k4, k5, k6]], OpenCV's order
  kEquirectangular,
  kRayMap,
  kOrthographic,
};

struct Lens {
  LensKind kind = LensKind::kPinhole;
  std::vector<double> distortion;      // empty for lenses without coefficients
  std::shared_ptr<const RayMap> rays;  // of a ray map, of the view's size
  std::string raysFile;                // its file beside cameras.json; may be empty
};

// Whether all rays of such a lens point forward by its definition: only then is a cell's depth a test of nearness.
bool looksForward(LensKind kind);

// A camera; axes x right, y down, z forward; pixel (0, 0) has its centre at (0.5, 0.5).
struct View {
  std::string name;  // the photo's file name, or "view_03"
  uint32_t width = 0, height = 0;
  // [pixels] centre of the image, and pixels per unit of what the lens draws: tangents of angles (pinhole,
  // radial-tangential), radians (fisheye, Kannala-Brandt, equirectangular) or scene units (orthographic). A ray map has
  // none.
  double fx = 0, fy = 0, cx = 0, cy = 0;
  Lens lens;
  std::array<double, 12> worldFromCamera{};  // 3 rows of 4
  std::optional<double> nearDepth;           // [scene units]; absent: the asset's default
  std::optional<double> nearRatio;
  std::string goldenColour, goldenAlpha, goldenDepth;  // file names beside cameras.json; may be empty
  double referencePsnr = 0;                            // against the photo, as published; 0: unknown
};

struct CameraSet {
  std::string scene;         // folder of the photos, relative to the data root; may be empty
  std::vector<View> views;   // test views
  std::vector<View> flight;  // key frames of a flight path; may be empty
};

// Views and intrinsics are checked: positive sizes and focal lengths, finite numbers, rotation orthonormal to 1e-4. Ray
// maps are read from the same folder.
Result<CameraSet> readCameras(const std::filesystem::path& path);
// The same from memory; `file` stands for it in messages. Ray maps are named, not read.
Result<CameraSet> parseCameras(std::span<const uint8_t> bytes, const std::string& file);
// Ray maps are named; writeRayMap writes them.
Status writeCameras(const std::filesystem::path& path, const CameraSet& cameras);
// What that writes; `file` stands for it in messages.
Result<std::string> camerasText(const CameraSet& cameras, const std::string& file);

// The same view at another size: intrinsics times W'/W and H'/H, ray maps interpolated; near limits stay.
View resizeView(const View& view, uint32_t width, uint32_t height);

}  // namespace froth
