#include "host/frame_files.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace froth {

constexpr uint32_t kMaxSheetPictures = 12;

Status FrameFiles::add(Image picture) {
  char name[32];
  std::snprintf(name, sizeof(name), "frame_%04u.png", added_);
  if (Status written = writePicture(options_.output / name, picture); !written) return written;
  if (isOnSheet()) sheet_.push_back(picture);
  last_ = std::move(picture);
  ++added_;
  return {};
}

// Evenly spread over the run, the first frame among them.
bool FrameFiles::isOnSheet() const {
  const uint64_t shown = std::min(options_.frames, kMaxSheetPictures);
  return added_ == 0 || added_ * shown / options_.frames != (added_ - 1) * shown / options_.frames;
}

Status FrameFiles::finish() const {
  if (Status written = writePicture(options_.output / "contact_sheet.png", contactSheet(sheet_)); !written) {
    return written;
  }
  std::printf("%u frames and contact_sheet.png in %s\n", added_, options_.output.c_str());
  return options_.compare.empty() ? Status() : compareWithExpected();
}

Status FrameFiles::compareWithExpected() const {
  const Result<Image> expected = readImage(options_.compare);
  if (!expected) return expected.error();
  const Result<double> psnr = comparePictures(*expected, last_);
  if (!psnr) return psnr.error();
  std::printf("last frame against %s: %.2f dB\n", options_.compare.c_str(), *psnr);
  if (*psnr >= options_.minPsnr) return {};
  return makeError(ErrorKind::kUnsupported, "the last frame is %.2f dB from %s, below --min-psnr %.2f", *psnr,
                   options_.compare.c_str(), options_.minPsnr);
}

}  // namespace froth
