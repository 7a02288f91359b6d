// Small photos of the gallery, and points on its surfaces as structure from motion would find them.
#pragma once

#include "trainer/loop/train_scene.h"

namespace froth::test {

struct GalleryCapture {
  Capture capture;
  TrainingSet set;
};

// Views from around one of the gallery's, ray traced; every eighth tests. Fails the test when that fails.
GalleryCapture makeGalleryCapture(uint32_t width, uint32_t height, bool hasPoints = true);

}  // namespace froth::test
