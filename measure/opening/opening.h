// How long it takes from the opening of an asset to its first image, and to the image that its view wants.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "measure/gpu/gpu_renderer.h"

namespace froth {

struct OpeningOptions {
  std::string asset;  // a file or a URL
  std::string device;
  uint32_t runs = 0;        // each in a context of its own; they share a VkPipelineCache
  bool keepsCache = false;  // else a file is dropped from the operating system's cache before each run
  View view;
  GpuRenderOptions render;
};

// Since the file or the URL was opened.
struct OpeningMark {
  double milliseconds = 0;
  uint32_t frames = 0;            // that were submitted and complete
  uint64_t reads = 0, bytes = 0;  // that the reader was asked for
  double processMs = 0;           // [ms] of all threads on the CPU; of a device that is a CPU its drawing too
};

struct Opening {
  double contextMs = 0;               // frothCreateContext
  double precompileMs = 0;            // as on a loading screen; of a URL 0: pipelines are made while the asset opens
  std::optional<double> cachedShare;  // of the file, just before [0..1]; absent: of a URL nobody knows
  OpeningMark head;                   // counts and cameras are known
  OpeningMark ready;                  // the asset, or its floor, is on its way to the GPU whole
  OpeningMark first;                  // a frame that lacks nothing of the asset or of its floor is complete
  OpeningMark settled;                // and one that draws all that its view wants
  double longestUpdateMs = 0;         // frothUpdate, up to `first`
  uint64_t diskBytes = 0;             // [bytes] that the process had from a disk, up to `settled` (/proc/self/io)
};

struct Openings {
  std::vector<Opening> runs;
  FrothAssetStatus asset{};
  std::string deviceName, driverName;
};

// The frames follow each other as fast as they can. Jobs run on a pool of two threads, reads of a file on another.
Result<Openings> openAndDraw(const OpeningOptions& options, const Progress& progress);

}  // namespace froth
