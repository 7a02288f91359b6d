#include "measure/flight/flight_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "measure/figures.h"

namespace froth {
namespace {

// PSNR [dB]: of the mean square over all images, and of the worst of them.
struct Range {
  double mean = 0, worst = 0;
};

// Of the frames from the first with the floor on.
struct Summary {
  std::optional<uint32_t> firstReady;                                            // frame; absent: never
  uint32_t settled = 0, lacking = 0, limited = 0, aboveBudget = 0, onFloor = 0;  // frames
  uint32_t longestUnsettled = 0, oldestRequest = 0;                              // [frames]
  uint64_t mostDeviceBytes = 0, mostChunkBytes = 0, missingPixels = 0;
  std::vector<double> updates, gpuTimes, fadingTimes;  // [ms] GPU: of all frames, and of those in a fade
  std::vector<std::pair<std::string, std::vector<double>>> passTimes;  // [ms] of frames that have it, in their order
  Range flown, settledError;
};

Range rangeOf(const std::vector<ComparedImage>& images, double ComparedImage::*figure) {
  if (images.empty()) return {};
  double square = 0;
  Range range{0, images.front().*figure};
  for (const ComparedImage& image : images) {
    square += std::pow(10, -(image.*figure) / 10) / static_cast<double>(images.size());
    range.worst = std::min(range.worst, image.*figure);
  }
  range.mean = -10 * std::log10(square);
  return range;
}

void addPasses(const FlownFrame& frame, Summary& summary) {
  std::map<std::string, double> ofFrame;
  for (const FrothPassTime& pass : frame.passes) ofFrame[pass.name] += pass.milliseconds;
  for (const FrothPassTime& pass : frame.passes) {
    const auto isNamed = [&](const auto& known) { return known.first == pass.name; };
    if (std::ranges::none_of(summary.passTimes, isNamed)) {
      summary.passTimes.emplace_back(pass.name, std::vector<double>{});
    }
  }
  for (auto& [name, times] : summary.passTimes) {
    if (ofFrame.contains(name)) times.push_back(ofFrame[name]);
  }
}

Summary summarize(const Flight& flight, const FlightOptions& options) {
  Summary summary;
  uint32_t unsettled = 0;
  for (uint32_t i = 0; i < flight.frames.size(); ++i) {
    const FlownFrame& frame = flight.frames[i];
    const uint64_t budget = options.scene.budget;
    summary.updates.push_back(frame.updateMs);
    summary.mostDeviceBytes = std::max(summary.mostDeviceBytes, frame.deviceBytes);
    summary.aboveBudget += budget > 0 && frame.deviceBytes > budget ? 1 : 0;
    if (!frame.isReady) continue;
    if (!summary.firstReady) summary.firstReady = i;
    summary.gpuTimes.push_back(frame.gpuMs);
    addPasses(frame, summary);
    if (frame.isFading) summary.fadingTimes.push_back(frame.gpuMs);
    summary.lacking += frame.isWhole ? 0 : 1;
    summary.limited += frame.isLimited ? 1 : 0;
    summary.settled += frame.stream.isSettled;
    summary.onFloor += frame.stream.floorHits > 0 ? 1 : 0;
    summary.oldestRequest = std::max(summary.oldestRequest, frame.stream.oldestRequest);
    summary.mostChunkBytes = std::max(summary.mostChunkBytes, frame.stream.usedBytes);
    unsettled = frame.stream.isSettled ? 0 : unsettled + 1;
    summary.longestUnsettled = std::max(summary.longestUnsettled, unsettled);
  }
  for (const ComparedImage& image : flight.images) summary.missingPixels += image.missing;
  summary.flown = rangeOf(flight.images, &ComparedImage::flown);
  summary.settledError = rangeOf(flight.images, &ComparedImage::settled);
  return summary;
}

nlohmann::ordered_json imagesAsJson(const std::vector<ComparedImage>& images) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ComparedImage& image : images) {
    json.push_back({{"frame", image.frame},
                    {"psnrFlown", image.flown},
                    {"psnrSettled", image.settled},
                    {"missingPixels", image.missing}});
  }
  return json;
}

nlohmann::ordered_json passesAsJson(const Summary& summary) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, times] : summary.passTimes) json[name] = frameTimesAsJson(times);
  return json;
}

nlohmann::ordered_json diskAsJson(const DiskOptions& disk) {
  return {{"latencyMs", disk.latency * 1e3},
          {"bytesPerSecond", disk.bytesPerSecond},
          {"failOnce", disk.failOnce},
          {"hasBadRange", disk.hasBadRange}};
}

}  // namespace

nlohmann::ordered_json frameTimesAsJson(const std::vector<double>& times) {
  if (times.empty()) return nullptr;
  return percentilesAsJson(percentilesOf(times));
}

void printFrameTimes(const char* name, const std::vector<double>& times) {
  if (times.empty()) return;
  const Percentiles found = percentilesOf(times);
  fmt::print("{:<24} median {:.3f}, 95 % {:.3f}, 99.9 % {:.3f}, longest {:.3f} ms\n", name, found.median, found.p95,
             found.p999, found.worst);
}

nlohmann::ordered_json sceneAsJson(const SceneOptions& scene, const std::string& deviceName,
                                   const std::string& driverName, size_t frames) {
  return {{"device", deviceName},
          {"driver", driverName},
          {"frames", frames},
          {"copies", scene.copies},
          {"width", scene.extent.width},
          {"height", scene.extent.height},
          {"cutoff", scene.render.cutoff},
          {"maxEntries", scene.render.maxEntries},
          {"budget", scene.budget},
          {"detail", scene.detail},
          {"mostCells", scene.mostCells},
          {"fadeFrames", scene.fadeFrames},
          {"reserveCells", scene.reserveCells}};
}

void printFlight(const Flight& flight, const FlightOptions& options) {
  const Summary summary = summarize(flight, options);
  const SceneOptions& scene = options.scene;
  fmt::print("{} frames of {}x{} on {} ({}), {} cells in {} chunks of all levels, {} times\n", flight.frames.size(),
             scene.extent.width, scene.extent.height, flight.deviceName, flight.driverName, flight.asset.cellCount,
             flight.asset.chunkCount, scene.copies);
  if (!summary.firstReady) {
    fmt::print("the floor did not come\n");
    return;
  }
  const auto ready = static_cast<double>(summary.gpuTimes.size());
  fmt::print("{:<24} frame {}\n", "first with the floor", *summary.firstReady);
  fmt::print("{:<24} {} of {} since then ({:.1f} %), longest time between {} frames; at rest after {}\n", "settled",
             summary.settled, ready, 100 * summary.settled / ready, summary.longestUnsettled, flight.framesToSettle);
  fmt::print("{:<24} {} frames that lack cells, {} pixels of {} images; {} frames met a limit of their rays\n",
             "missing", summary.lacking, summary.missingPixels, flight.images.size(), summary.limited);
  fmt::print("{:<24} {} frames show a chunk of the floor where a finer one is wanted; oldest request {} frames\n",
             "waiting", summary.onFloor, summary.oldestRequest);
  fmt::print("{:<24} {} evictions, {} retries, {} failures, {:.1f} MiB read\n", "chunks", flight.atEnd.evictions,
             flight.atEnd.retries, flight.atEnd.failures, static_cast<double>(flight.bytesRead) / kMebi);
  fmt::print("{:<24} {:.1f} MiB at most, {:.1f} of them chunks; {} frames above the budget\n", "device memory",
             static_cast<double>(summary.mostDeviceBytes) / kMebi, static_cast<double>(summary.mostChunkBytes) / kMebi,
             summary.aboveBudget);
  printFrameTimes("frothUpdate", summary.updates);
  printFrameTimes("GPU", summary.gpuTimes);
  for (const auto& [name, times] : summary.passTimes) printFrameTimes(("  " + name).c_str(), times);
  printFrameTimes("GPU, in a fade", summary.fadingTimes);
  fmt::print("{:<24} flown {:.2f}, worst {:.2f}; at rest {:.2f}, worst {:.2f} dB\n", "PSNR of all images",
             summary.flown.mean, summary.flown.worst, summary.settledError.mean, summary.settledError.worst);
}

nlohmann::ordered_json flightAsJson(const Flight& flight, const FlightOptions& options) {
  const Summary summary = summarize(flight, options);
  nlohmann::ordered_json json = sceneAsJson(options.scene, flight.deviceName, flight.driverName, flight.frames.size());
  json.update({{"isFromRest", options.isFromRest},
               {"jumpEvery", options.jumpEvery},
               {"disk", diskAsJson(options.scene.disk)},
               {"cells", flight.asset.cellCount},
               {"chunks", flight.asset.chunkCount},
               {"settledFrames", summary.settled},
               {"readyFrames", summary.gpuTimes.size()},
               {"longestUnsettled", summary.longestUnsettled},
               {"framesToSettle", flight.framesToSettle},
               {"lackingFrames", summary.lacking},
               {"limitedFrames", summary.limited},
               {"missingPixels", summary.missingPixels},
               {"floorFrames", summary.onFloor},
               {"oldestRequest", summary.oldestRequest},
               {"evictions", flight.atEnd.evictions},
               {"retries", flight.atEnd.retries},
               {"failures", flight.atEnd.failures},
               {"bytesRead", flight.bytesRead},
               {"mostDeviceBytes", summary.mostDeviceBytes},
               {"mostChunkBytes", summary.mostChunkBytes},
               {"framesAboveBudget", summary.aboveBudget},
               {"updateMs", frameTimesAsJson(summary.updates)},
               {"gpuMs", frameTimesAsJson(summary.gpuTimes)},
               {"passesMs", passesAsJson(summary)},
               {"fadingFrames", summary.fadingTimes.size()},
               {"gpuFadingMs", frameTimesAsJson(summary.fadingTimes)},
               {"psnrFlown", {{"mean", summary.flown.mean}, {"worst", summary.flown.worst}}},
               {"psnrSettled", {{"mean", summary.settledError.mean}, {"worst", summary.settledError.worst}}},
               {"images", imagesAsJson(flight.images)}});
  json["firstReady"] = summary.firstReady ? nlohmann::ordered_json(*summary.firstReady) : nullptr;
  return json;
}

}  // namespace froth
