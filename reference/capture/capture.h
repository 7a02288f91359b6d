// Photos of a scene, how each was taken, and the points that were found with that: what COLMAP and transforms.json
// describe (docs/TRAINING.md "Input").
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/result.h"
#include "reference/camera/camera.h"

namespace froth {

// Which pixels of a mask leave their photo's pixels out.
enum class MaskSense {
  kBlackIgnored,  // masks/, nerfstudio's mask_path
  kWhiteIgnored,  // instant-ngp's dynamic_mask_*
};

// What the capture itself says of a photo's use.
enum class CapturePart { kUnsaid, kTraining, kTest };

struct CapturedView {
  View view;                    // of the photo's size; its name is the photo's, with folders: "left/0001.jpg"
  std::filesystem::path photo;  // of a COLMAP model not looked at: it may be missing
  std::filesystem::path mask;   // empty: none
  MaskSense maskSense = MaskSense::kBlackIgnored;
  CapturePart part = CapturePart::kUnsaid;
};

// From structure from motion.
struct CapturedPoint {
  glm::dvec3 position{0};  // [scene units]
  std::array<uint8_t, 3> colour{};
  uint64_t firstObserver = 0;  // into Capture::observers
  uint32_t observerCount = 0;  // 0: it is not known which views show it
};

struct Capture {
  std::vector<CapturedView> views;    // at least one; by name, bytewise; names are unique
  std::vector<CapturedPoint> points;  // may be none
  std::filesystem::path pointFile;    // of transforms.json, which readCapture() takes the points from; empty: none
  std::vector<uint32_t> observers;    // indices of views, ascending for each point
  std::vector<std::string> leftOut;   // names of frames without a photo
};

// `path` is one of
//   a folder with a COLMAP model in it (sparse/0, sparse, or itself; binary before text), photos in images/
//   a folder with transforms.json, or with transforms_train.json and transforms_test.json or transforms_val.json
//   a file of that form.
// Frames of transforms.json without a photo are left out, as instant-ngp leaves them out, unless no frame has one.
// Points of transforms.json are those of the PLY file that it names, if that is there.
// Masks are found by the photo's name: masks/NAME.png, then masks/STEM.png; dynamic_mask_STEM.png beside the photo.
// Poses and intrinsics are checked as those of cameras.json are.
Result<Capture> readCapture(const std::filesystem::path& path);

}  // namespace froth
