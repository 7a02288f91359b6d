// What a headless run leaves: frames, a contact sheet, and a comparison for CI.
#pragma once

#include <vector>

#include "host/command_line.h"
#include "host/picture_file.h"

namespace froth {

class FrameFiles {
 public:
  // `options` outlives it; options.frames are going to be added, at least one.
  explicit FrameFiles(const RunOptions& options) : options_(options) {}

  Status add(Image picture);  // frame_0000.png and so on
  // contact_sheet.png; fails if the last frame does not resemble options.compare.
  Status finish() const;

 private:
  bool isOnSheet() const;
  Status compareWithExpected() const;

  const RunOptions& options_;
  uint32_t added_ = 0;
  std::vector<Image> sheet_;
  Image last_;
};

}  // namespace froth
