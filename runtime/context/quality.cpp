#include "runtime/context/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <iterator>

#include "runtime/context/info_checks.h"

namespace froth {
namespace {

constexpr float kDefaultLeastShare = 0.5f;  // of mostScale
constexpr float kDefaultReducedCutoff = 1e-2f;

// Of the target. What raised the scale never lowers it again, as far as times go with up to the power 1.5 of the area:
// a frame that took t < kRaiseBelow takes less than 1 when it grows, min(kMostGrowth, kAim / t)^1.5 t < 0.93, also with
// the 5 % that the finer cut-off costs. Noise of 10 % around kAim changes nothing.
constexpr double kAim = 0.9;
constexpr double kRaiseBelow = 0.75;
constexpr double kMostGrowth = 1.15;  // of the area, in a step
constexpr double kMostShrinkage = 0.5;

constexpr uint32_t kDrawn = std::size(FrothQuality{}.drawnSerials);
constexpr uint32_t kMeasured = std::size(FrothQuality{}.costs);
constexpr uint32_t kJudged = 3;  // newest measured frames, of which a single one decides nothing

double areaOf(float scale) { return double{scale} * scale; }

// The scale with which a frame was drawn; 0: it is unknown, or too old.
float scaleOf(const FrothQuality& quality, uint64_t serial) {
  const uint32_t count = std::min(quality.drawnCount, kDrawn);
  const auto* end = quality.drawnSerials + count;
  const auto* found = std::find(quality.drawnSerials, end, serial);
  return found == end ? 0 : quality.drawnScales[found - quality.drawnSerials];
}

// By area alone: what a frame costs besides is then counted as if it went with the area too. From the same frame that
// gives a step that is too short, either way, and never one that goes too far.
void takeTime(const FrothQualityTimes& times, FrothQuality& quality) {
  if (times.measuredSerial <= quality.measuredSerial || times.milliseconds == 0) return;
  const float scale = scaleOf(quality, times.measuredSerial);
  if (scale == 0) return;
  quality.measuredSerial = times.measuredSerial;
  quality.costs[quality.measuredCount++ % kMeasured] = times.milliseconds / areaOf(scale);
  quality.steadyCount = scale == quality.scale ? quality.steadyCount + 1 : 0;
}

// Of the newest `count` measured frames, the one with `above` more expensive ones. count: at most kMeasured, and as
// many as were measured.
double costOf(const FrothQuality& quality, uint32_t count, uint32_t above) {
  std::array<double, kMeasured> costs{};
  for (uint32_t i = 0; i < count; ++i) costs[i] = quality.costs[(quality.measuredCount - 1 - i) % kMeasured];
  // strong_order: whatever stands in the caller's memory
  std::sort(costs.begin(), costs.begin() + count,
            [](double a, double b) { return std::is_gt(std::strong_order(a, b)); });
  return costs[above];
}

// What the area is to be multiplied with.
double changeOfArea(const FrothQuality& quality, double target) {
  const double area = areaOf(quality.scale);
  if (quality.measuredCount >= kJudged) {
    const double share = costOf(quality, kJudged, kJudged / 2) * area / target;
    if (share > 1) return std::max(kAim / share, kMostShrinkage);
  }
  if (quality.steadyCount >= kMeasured) {
    const double share = costOf(quality, kMeasured, 1) * area / target;
    if (share < kRaiseBelow) return std::min(kAim / share, kMostGrowth);
  }
  return 1;
}

FrothResult checkQuality(const Messages& messages, const char* call, const FrothQualityInfo& info,
                         const FrothQualityTimes& times, const FrothQuality& quality) {
  const auto refuse = [&](const char* field, double found, const char* valid) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: %g; must be %s", field, found, valid);
  };
  if (!(info.targetMilliseconds > 0 && std::isfinite(info.targetMilliseconds))) {
    return refuse("targetMilliseconds", double{info.targetMilliseconds}, "positive and finite");
  }
  if (!(info.mostScale > 0 && info.mostScale <= 1)) {
    return refuse("mostScale", double{info.mostScale}, "above 0 and at most 1, or 0 for 1");
  }
  if (!(info.leastScale > 0 && info.leastScale <= info.mostScale)) {
    return refuse("leastScale", double{info.leastScale}, "above 0 and at most mostScale, or 0 for a half of that");
  }
  if (!(info.cutoff < 1)) return refuse("cutoff", double{info.cutoff}, "below 1");
  if (!(info.reducedCutoff < 1)) return refuse("reducedCutoff", double{info.reducedCutoff}, "below 1");
  if (!(times.milliseconds >= 0 && std::isfinite(times.milliseconds))) {
    return refuse("milliseconds", times.milliseconds, "finite, and 0 where nothing was measured");
  }
  const uint64_t before = quality.drawnCount > 0 ? quality.drawnSerials[(quality.drawnCount - 1) % kDrawn] : 0;
  if (times.serial <= before) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "serial: %llu after %llu; must grow; to start anew, zero *quality",
                         static_cast<unsigned long long>(times.serial), static_cast<unsigned long long>(before));
  }
  return FROTH_OK;
}

}  // namespace

FrothResult stepQuality(const Messages& messages, const char* call, FrothQualityInfo info,
                        const FrothQualityTimes& times, FrothQuality& quality) {
  if (info.mostScale == 0) info.mostScale = 1;
  if (info.leastScale == 0) info.leastScale = kDefaultLeastShare * info.mostScale;
  if (info.cutoff == 0) info.cutoff = kDefaultCutoff;
  if (info.reducedCutoff == 0) info.reducedCutoff = kDefaultReducedCutoff;
  if (const FrothResult result = checkQuality(messages, call, info, times, quality); result != FROTH_OK) return result;
  if (quality.drawnCount == 0) quality.scale = info.mostScale;
  takeTime(times, quality);
  const float before = quality.scale;
  const double change = changeOfArea(quality, double{info.targetMilliseconds});
  quality.scale = std::clamp(static_cast<float>(before * std::sqrt(change)), info.leastScale, info.mostScale);
  if (quality.scale != before) quality.steadyCount = 0;
  quality.cutoff = quality.scale < info.mostScale ? info.reducedCutoff : info.cutoff;
  quality.drawnSerials[quality.drawnCount % kDrawn] = times.serial;
  quality.drawnScales[quality.drawnCount++ % kDrawn] = quality.scale;
  return FROTH_OK;
}

}  // namespace froth
