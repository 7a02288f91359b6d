#include "samples/flythrough/stream_report.h"

#include <cstdio>
#include <fstream>

namespace froth {
namespace {

// Chunks by level.
std::vector<uint32_t> countDrawn(const StreamFigures& figures, uint32_t levelCount) {
  std::vector<uint32_t> counts(levelCount, 0);
  for (const FrothChunk& chunk : figures.chunks) counts[chunk.level] += chunk.state == FROTH_CHUNK_DRAWN;
  return counts;
}

nlohmann::ordered_json asJson(const StreamFigures& figures, uint32_t levelCount) {
  const FrothStreamStatus& status = figures.status;
  return {{"isSettled", status.isSettled != 0},
          {"drawnChunks", status.drawnChunks},
          {"drawnByLevel", countDrawn(figures, levelCount)},
          {"residentChunks", status.residentChunks},
          {"comingChunks", status.comingChunks},
          {"failedChunks", status.failedChunks},
          {"usedBytes", status.usedBytes},
          {"budgetBytes", status.budgetBytes},
          {"excessBytes", status.excessBytes},
          {"oldestRequest", status.oldestRequest},
          {"floorHits", status.floorHits},
          {"evictions", status.evictions},
          {"retries", status.retries},
          {"failures", status.failures}};
}

}  // namespace

void StreamReport::add(const StreamFigures& figures) {
  settledFrames_ += figures.status.isSettled != 0;
  frames_.push_back(asJson(figures, levelCount_));
  last_ = figures;
}

Status StreamReport::finish() const {
  if (levelCount_ > 1) {
    constexpr double kMebi = 1024.0 * 1024.0;
    std::printf("streaming: %u of %zu frames settled; last frame: chunks drawn by level", settledFrames_,
                frames_.size());
    for (const uint32_t count : countDrawn(last_, levelCount_)) std::printf(" %u", count);
    std::printf(", %u resident, %.1f MiB; %llu evictions\n", last_.status.residentChunks,
                static_cast<double>(last_.status.usedBytes) / kMebi,
                static_cast<unsigned long long>(last_.status.evictions));
  }
  if (options_.json.empty()) return {};
  const nlohmann::ordered_json root = {{"budget", options_.streaming.budget},
                                       {"detail", options_.streaming.detail},
                                       {"levels", levelCount_},
                                       {"chunks", last_.chunks.size()},
                                       {"frames", frames_}};
  std::ofstream file(options_.json);
  file << root.dump(2) << "\n";
  if (file.good()) return {};
  return makeError(ErrorKind::kIo, "%s: cannot be written; check the folder and the free space", options_.json.c_str());
}

}  // namespace froth
