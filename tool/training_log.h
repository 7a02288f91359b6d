// What training measures on its way, as lines of JSON in a file.
#pragma once

#include <filesystem>
#include <fstream>

#include "base/result.h"
#include "trainer/loop/train_scene.h"

namespace froth {

// One object a line: {"steps", "seconds", "cells", "psnr"}, written at once. psnr: null without test photos.
class TrainingLog {
 public:
  // Begins the file anew, or goes on at its end.
  Status open(const std::filesystem::path& path, bool goesOn);
  Status write(const TrainingMoment& moment);

 private:
  std::filesystem::path path_;
  std::ofstream file_;
};

}  // namespace froth
