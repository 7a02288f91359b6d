// What views see of a foam whose cells have owners: the picture of a level, and whose each pixel is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

inline constexpr uint32_t kNoOwner = 0xffffffff;

struct FrontImage {
  std::vector<glm::vec3> colours;  // [pixels] display-coded, over black
  std::vector<uint32_t> owners;    // [pixels] of the cell that shows most; kNoOwner: none shows
  std::vector<float> distances;    // [pixels] from the eye to the site of that cell [scene units]
};

struct FrontOptions {
  double nearRatio = 4, nearDepth = 0;  // where a view does not say
};

// `owners`: [cells]. By the float reference, one image per view; the same bits on any number of threads. Fails with
// kCancelled.
Result<std::vector<FrontImage>> drawFront(const Foam& foam, std::span<const uint32_t> owners,
                                          std::span<const View> views, const FrontOptions& options,
                                          const Progress& progress = {});

}  // namespace froth
