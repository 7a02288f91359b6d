// Views as cameras.json describes them (docs/CAMERAS.md).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/result.h"

namespace froth {

// A pinhole camera; axes x right, y down, z forward; pixel (0, 0) has its centre at (0.5, 0.5).
struct View {
  std::string name;  // the photo's file name, or "view_03"
  uint32_t width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;     // [pixels]
  std::array<double, 12> worldFromCamera{};  // 3 rows of 4
  std::optional<double> nearDepth;           // [scene units]; absent: the asset's default
  std::optional<double> nearRatio;
  std::string goldenColour, goldenAlpha, goldenDepth;  // file names beside cameras.json; may be empty
  double referencePsnr = 0;                            // against the photo, as published; 0: unknown
};

struct CameraSet {
  std::string scene;          // folder of the photos, relative to the data root; may be empty
  std::vector<View> views;    // test views
  std::vector<View> flight;   // key frames of a flight path; may be empty
};

// Views and intrinsics are checked: positive sizes and focal lengths, finite numbers, rotation orthonormal to 1e-4.
Result<CameraSet> readCameras(const std::filesystem::path& path);
// The same from memory; `file` stands for it in messages.
Result<CameraSet> parseCameras(std::span<const uint8_t> bytes, const std::string& file);
Status writeCameras(const std::filesystem::path& path, const CameraSet& cameras);

// The same view at another size: intrinsics times W'/W and H'/H; near limits stay.
View resizeView(const View& view, uint32_t width, uint32_t height);

}  // namespace froth
