// Foams made procedurally, and the analytic scenes they come from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/image/image.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

struct SynthOptions {
  std::string name;        // "gallery", "one", "two", "grid", "shell", "random"
  uint32_t cellCount = 0;  // 0: the scene's default (gallery 200,000)
  uint64_t seed = 1;
  uint32_t detailCount = 0, lobeCount = 0;  // of the gallery, K and M [1..32]; 0: 8 each
};

std::vector<std::string> synthNames();

// The same options give the same foam, bit for bit, on any number of threads.
Result<Foam> synthesizeFoam(const SynthOptions& options, const Progress& progress = {});

// Twelve test views and a flight path of the gallery.
CameraSet galleryCameras();

// Ray traces the analytic gallery itself: `samples` per pixel, stratified, display-coded colours averaged in
// display space.
Result<Image> traceGallery(const View& view, uint32_t samples, const Progress& progress = {});

// `count` copies of a foam on a grid, each turned about an axis by its own angle and set apart by a gap of 5
// % of the bounding box; copy 0 is the original in place. Lobe axes turn with the copy. Refuses more than
// 2^32 - 1 cells.
Result<Foam> tileFoam(const Foam& foam, uint32_t count);

}  // namespace froth
