// A flight along a camera path with streaming, and how far its images are from those of unlimited memory.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "host/camera_path.h"
#include "measure/flight/streamed_scene.h"

namespace froth {

struct FlightOptions {
  SceneOptions scene;
  uint32_t frames = 0;       // at least 2
  bool isFromRest = false;   // they begin when all that the first view wants is drawn
  uint32_t jumpEvery = 0;    // [frames] the camera goes on elsewhere on the path; 0: never
  uint32_t imageEvery = 50;  // [frames] between images that are compared
  std::string device;        // as GpuDeviceOptions
};

// Against the image of the same view with all cells of level 0, PSNR [dB].
struct ComparedImage {
  uint32_t frame = 0;
  double flown = 0;      // as it was drawn in the flight
  double settled = 0;    // when all that is wanted within the budget was drawn
  uint64_t missing = 0;  // pixels of the flown image without a hit where the other has one
};

struct Flight {
  std::vector<FlownFrame> frames;
  std::vector<ComparedImage> images;  // of frames with the floor
  uint64_t bytesRead = 0;             // [bytes] from the disk
  uint32_t framesToSettle = 0;        // at the end, at rest
  FrothStreamStatus atEnd{};          // at rest
  FrothAssetStatus asset{};
  std::string deviceName, driverName;
};

// The view of frame `frame` of the flight.
View viewOf(const CameraPath& path, const FlightOptions& options, uint32_t frame);

// The same figures on each run but for times.
Result<Flight> fly(const CameraPath& path, const FlightOptions& options, const Progress& progress);

}  // namespace froth
