#include "measure/flight/pops_figures.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "measure/flight/flight_figures.h"

namespace froth {
namespace {

constexpr double kShare = 0.9999;  // of the pixels of all frames

struct Row {
  const char *name, *key;
  uint32_t frames = 0, movedChunks = 0;
  FrameChange worst;        // the frame with the largest change
  uint32_t worstFrame = 0;  // the later one of its two
  double mostOfError = 0;
  uint64_t seenPixels = 0, mostSeenPixels = 0;
  double quantile = 0;

  double meanSeenPixels() const { return frames > 0 ? static_cast<double>(seenPixels) / frames : 0; }
};

Row rowOf(const char* name, const char* key, const std::vector<FrameChange>& frames, const PixelChanges& changes,
          const auto& isIn) {
  Row row{name, key, 0, 0, {}, 0, 0, 0, 0, changes.quantile(kShare)};
  for (uint32_t i = 0; i < frames.size(); ++i) {
    const FrameChange& frame = frames[i];
    if (!isIn(frame)) continue;
    ++row.frames;
    row.movedChunks += frame.movedChunks;
    row.mostOfError = std::max(row.mostOfError, frame.mostOfError);
    row.seenPixels += frame.seenPixels;
    row.mostSeenPixels = std::max(row.mostSeenPixels, frame.seenPixels);
    if (row.worstFrame > 0 && frame.most <= row.worst.most) continue;
    row.worst = frame;
    row.worstFrame = i + 1;
  }
  return row;
}

std::vector<Row> rowsOf(const Pops& pops) {
  const auto isMoved = [](const FrameChange& frame) { return frame.movedChunks > 0; };
  const auto isAny = [](const FrameChange&) { return true; };
  std::vector<Row> rows = {
      rowOf("all cells", "allCells", pops.whole, pops.wholeChanges, isAny),
      rowOf("levels, cut stays", "cutStays", pops.levels, pops.still, [&](const auto& f) { return !isMoved(f); }),
      rowOf("levels, cut changes", "cutChanges", pops.levels, pops.moved, isMoved)};
  if (!pops.faded.empty()) rows.push_back(rowOf("levels that fade", "faded", pops.faded, pops.fadedChanges, isAny));
  return rows;
}

nlohmann::ordered_json framesAsJson(const Pops& pops) {
  nlohmann::ordered_json frames = nlohmann::ordered_json::array();
  for (size_t i = 0; i < pops.levels.size(); ++i) {
    const FrameChange &levels = pops.levels[i], &whole = pops.whole[i];
    frames.push_back({{"frame", i + 1},
                      {"movedChunks", levels.movedChunks},
                      {"most", levels.most},
                      {"seenPixels", levels.seenPixels},
                      {"mostOfError", levels.mostOfError},
                      {"mostAllCells", whole.most},
                      {"seenPixelsAllCells", whole.seenPixels}});
    if (pops.faded.empty()) continue;
    frames.back()["movedChunksFaded"] = pops.faded[i].movedChunks;
    frames.back()["mostFaded"] = pops.faded[i].most;
    frames.back()["mostOfErrorFaded"] = pops.faded[i].mostOfError;
  }
  return frames;
}

}  // namespace

void printPops(const Pops& pops, const FlightOptions& options) {
  const SceneOptions& scene = options.scene;
  fmt::print("{} frames of {}x{} on {} ({}), {} cells in {} chunks of all levels, detail {}\n", options.frames,
             scene.extent.width, scene.extent.height, pops.deviceName, pops.driverName, pops.asset.cellCount,
             pops.asset.chunkCount, scene.detail);
  fmt::print(
      "{:.4g} forwards in each: the median surface, {:.4g} away at the start, moves by a tenth of a pixel at the "
      "edge\n",
      pops.step, pops.distance);
  fmt::print("{:<20} {:>7} {:>15} {:>9} {:>16} {:>8} {:>22} {:>17} {:>20}\n", "change of pixels", "frames",
             "largest, of 255", "in frame", "of the error", "99.99 %", "pixels above 8/255: mean", "most of a frame",
             "chunks in and out");
  for (const Row& row : rowsOf(pops)) {
    fmt::print("{:<20} {:>7} {:>15.1f} {:>9} {:>16.1f} {:>8.1f} {:>24.2f} {:>17} {:>20}\n", row.name, row.frames,
               255 * row.worst.most, row.worstFrame, 255 * row.mostOfError, 255 * row.quantile, row.meanSeenPixels(),
               row.mostSeenPixels, fmt::format("{} ({} in it)", row.movedChunks, row.worst.movedChunks));
  }
  printFrameTimes("GPU, in a fade", pops.gpuFading);
  printFrameTimes("GPU, not in a fade", pops.gpuStill);
}

nlohmann::ordered_json popsAsJson(const Pops& pops, const FlightOptions& options) {
  const SceneOptions& scene = options.scene;
  nlohmann::ordered_json json = sceneAsJson(scene, pops.deviceName, pops.driverName, options.frames);
  json.update({{"cells", pops.asset.cellCount},
               {"chunks", pops.asset.chunkCount},
               {"distance", pops.distance},
               {"step", pops.step}});
  for (const Row& row : rowsOf(pops)) {
    json[row.key] = {{"frames", row.frames},
                     {"most", row.worst.most},
                     {"frameOfMost", row.worstFrame},
                     {"mostOfError", row.mostOfError},
                     {"movedChunksInIt", row.worst.movedChunks},
                     {"p9999", row.quantile},
                     {"meanSeenPixels", row.meanSeenPixels()},
                     {"mostSeenPixels", row.mostSeenPixels},
                     {"movedChunks", row.movedChunks}};
  }
  if (scene.fadeFrames > 0) {
    json["gpuFadingMs"] = frameTimesAsJson(pops.gpuFading);
    json["gpuStillMs"] = frameTimesAsJson(pops.gpuStill);
  }
  json["changes"] = framesAsJson(pops);
  return json;
}

}  // namespace froth
