// COLMAP's sparse models.
#pragma once

#include <filesystem>

#include "foam/checkpoint/bad_input.h"
#include "reference/capture/capture.h"

namespace froth {

// The three files of a model, of one form.
struct ColmapFiles {
  NamedBytes cameras, images, points;
  bool isBinary = true;
};

// Views and points, without photos and masks: views are sorted by name. Camera models become lenses: PINHOLE and
// SIMPLE_PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV and FULL_OPENCV (radial-tangential), SIMPLE_RADIAL_FISHEYE,
// RADIAL_FISHEYE and OPENCV_FISHEYE (Kannala-Brandt). Any bytes give a capture or an error.
Result<Capture> parseColmap(const ColmapFiles& files);

// Reads cameras, images and points3D of a folder, .bin where cameras.bin is there, else .txt.
Result<Capture> readColmapModel(const std::filesystem::path& folder);

// Whether a folder holds cameras.bin or cameras.txt.
bool hasColmapModel(const std::filesystem::path& folder);

}  // namespace froth
