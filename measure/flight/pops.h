// How pixels change while the camera moves slowly: with levels of detail, whose cuts change on the way, and with all
// cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/image/image.h"
#include "base/progress.h"
#include "base/result.h"
#include "measure/flight/flight.h"

namespace froth {

// Of a pixel between two frames: the largest difference of its channels, display-coded [0..1].
constexpr double kSeenChange = 8.0 / 255;  // what more than this is, is counted

struct FrameChange {
  double most = 0;           // of a pixel
  double mostOfError = 0;    // the same of the difference from all cells: what does not come from the movement
  uint64_t seenPixels = 0;   // that change by more than kSeenChange
  uint32_t movedChunks = 0;  // that come into the cut, and that leave it
};

// Over the pixels of many frames.
class PixelChanges {
 public:
  // From a frame to the next one, of the same size.
  FrameChange add(const Image& before, const Image& now);

  uint64_t pixels() const { return pixels_; }
  // The least change that this share [0..1] of the pixels does not pass, to 1 / 4096; 0 without pixels.
  double quantile(double share) const;

 private:
  static constexpr size_t kBins = 4096;  // of 0..1; one more for what is above
  std::array<uint64_t, kBins + 1> counts_{};
  uint64_t pixels_ = 0;
};

struct Pops {
  double distance = 0;  // [asset units] of the median surface of the first view
  double step = 0;      // [asset units] of the camera in a frame
  // From frame i to i + 1; seen with levels, with levels that fade (none without SceneOptions::fadeFrames), and with
  // all cells.
  std::vector<FrameChange> levels, faded, whole;
  PixelChanges still, moved;  // with levels: frames whose cut is that of the frame before, and others
  PixelChanges fadedChanges, wholeChanges;
  std::vector<double> gpuFading, gpuStill;  // [ms] of the frames with levels that fade: in a fade, and others
  FrothAssetStatus asset{};
  std::string deviceName, driverName;
};

// `options.frames` frames forwards from a pinhole view of the scene's extent. In each of them the median surface, as it
// lies in the first one, moves by a tenth of a pixel at the middle of the upper edge. All scenes are settled at the
// start. The same figures on each run but for times.
Result<Pops> measurePops(const View& first, const FlightOptions& options, const Progress& progress);

}  // namespace froth
