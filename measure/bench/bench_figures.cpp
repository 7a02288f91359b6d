#include "measure/bench/bench_figures.h"

#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "measure/figures.h"

namespace froth {
namespace {

constexpr uint32_t kSubTileSize = 8;  // [pixels] of the workgroups that FrothWork speaks of

void printTimes(const std::string& name, const Percentiles& frames, const Percentiles& cycles) {
  fmt::print("{:<12} {:>10.4f} {:>10.4f} {:>10.4f}   {:>10.4f} {:>10.4f} {:>10.4f}\n", name, frames.median, frames.p5,
             frames.p95, cycles.median, cycles.p5, cycles.p95);
}

// The newest frame of a cycle is its last but views.size() of all totals.
void closeCycle(Measurement& measurement) {
  const size_t views = measurement.viewTotals.size();
  const auto meanOfLast = [&](const std::vector<double>& values, size_t frames) {
    return std::accumulate(values.end() - static_cast<std::ptrdiff_t>(frames), values.end(), 0.0) /
           static_cast<double>(views);
  };
  measurement.cycleTotals.push_back(meanOfLast(measurement.totals, views));
  for (const std::string& name : measurement.passOrder) {
    const std::vector<double>& times = measurement.passTimes.at(name);
    measurement.cyclePasses[name].push_back(meanOfLast(times, std::min(views, times.size())));
  }
}

struct WorkAverages {
  double rays = 0, subTiles = 0;  // of a cycle
  double pairs = 0;               // of a frame
  FrothWork sum{};                // of a cycle
};

WorkAverages averageWork(const Measurement& measurement, const std::vector<SelectedView>& views) {
  WorkAverages averages;
  for (size_t i = 0; i < views.size(); ++i) {
    const View& view = views[i].view;
    const FrothViewStatus& status = measurement.viewStatus[i];
    const auto blocks = [](uint32_t pixels) { return (pixels + kSubTileSize - 1) / kSubTileSize; };
    averages.rays += static_cast<double>(view.width) * view.height;
    averages.subTiles += static_cast<double>(blocks(view.width)) * blocks(view.height);
    averages.pairs += static_cast<double>(status.pairs) / static_cast<double>(views.size());
    averages.sum.entries += status.work.entries;
    averages.sum.entriesKept += status.work.entriesKept;
    averages.sum.ballHits += status.work.ballHits;
    averages.sum.planes += status.work.planes;
    averages.sum.heights += status.work.heights;
    averages.sum.colours += status.work.colours;
    averages.sum.steps += status.work.steps;
    averages.sum.neighbours += status.work.neighbours;
  }
  return averages;
}

nlohmann::ordered_json partsAsJson(std::span<const FrothMemory> parts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const FrothMemory& part : parts) json[part.name] = part.bytes;
  return json;
}

void printParts(const char* owner, uint64_t sum, std::span<const FrothMemory> parts) {
  fmt::print("{:<28} {:>10.2f} MiB\n", owner, static_cast<double>(sum) / kMebi);
  for (const FrothMemory& part : parts) {
    fmt::print("  {:<26} {:>10.2f}\n", part.name, static_cast<double>(part.bytes) / kMebi);
  }
}

}  // namespace

void addFrame(Measurement& measurement, size_t view, const FrothViewStatus& status) {
  double total = 0;
  for (uint32_t pass = 0; pass < status.passCount; ++pass) {
    const FrothPassTime& time = status.passes[pass];
    auto [entry, isNew] = measurement.passTimes.try_emplace(time.name);
    if (isNew) measurement.passOrder.push_back(time.name);
    entry->second.push_back(time.milliseconds);
    total += time.milliseconds;
  }
  measurement.totals.push_back(total);
  measurement.viewTotals[view].push_back(total);
  measurement.viewStatus[view] = status;
  if (view + 1 == measurement.viewTotals.size()) closeCycle(measurement);
}

void printMeasurement(const Measurement& measurement) {
  fmt::print("{:<12} {:>32}   {:>32}\n", "[ms]", "frames: median, p5, p95", "cycles: median, p5, p95");
  for (const std::string& name : measurement.passOrder) {
    printTimes(name, percentilesOf(measurement.passTimes.at(name)), percentilesOf(measurement.cyclePasses.at(name)));
  }
  const Percentiles totals = percentilesOf(measurement.totals);
  printTimes("total", totals, percentilesOf(measurement.cycleTotals));
  fmt::print("of all {} frames: p99.9 {:.4f}, worst {:.4f}\n", measurement.totals.size(), totals.p999, totals.worst);
}

nlohmann::ordered_json measurementAsJson(const Measurement& measurement, const std::vector<SelectedView>& views) {
  nlohmann::ordered_json passes = nlohmann::ordered_json::object(), cyclePasses = passes;
  for (const std::string& name : measurement.passOrder) {
    passes[name] = percentilesAsJson(percentilesOf(measurement.passTimes.at(name)));
    cyclePasses[name] = percentilesAsJson(percentilesOf(measurement.cyclePasses.at(name)));
  }
  nlohmann::ordered_json perView = nlohmann::ordered_json::array();
  for (size_t i = 0; i < views.size(); ++i) {
    const FrothViewStatus& status = measurement.viewStatus[i];
    perView.push_back({{"view", views[i].index},
                       {"total", percentilesAsJson(percentilesOf(measurement.viewTotals[i]))},
                       {"visibleCells", status.visibleCells},
                       {"pairs", status.pairs},
                       {"longestList", status.longestList},
                       {"stepLimit", (status.bits & FROTH_VIEW_STEP_LIMIT) != 0}});
  }
  const double sum = std::accumulate(measurement.totals.begin(), measurement.totals.end(), 0.0);
  nlohmann::ordered_json total = percentilesAsJson(percentilesOf(measurement.totals));
  total["mean"] = sum / static_cast<double>(measurement.totals.size());
  return {{"unit", "ms"},
          {"total", total},
          {"passes", passes},
          {"cycles",
           {{"count", measurement.cycleTotals.size()},
            {"total", percentilesAsJson(percentilesOf(measurement.cycleTotals))},
            {"passes", cyclePasses}}},
          {"views", perView}};
}

nlohmann::ordered_json workAsJson(const Measurement& measurement, const std::vector<SelectedView>& views) {
  const WorkAverages averages = averageWork(measurement, views);
  const FrothWork& sum = averages.sum;
  const auto perRay = [&](uint64_t count) { return static_cast<double>(count) / averages.rays; };
  const auto perSubTile = [&](uint64_t count) { return static_cast<double>(count) / averages.subTiles; };
  return {{"pairs", averages.pairs},
          {"perSubTile", {{"entries", perSubTile(sum.entries)}, {"entriesKept", perSubTile(sum.entriesKept)}}},
          {"perRay",
           {{"ballHits", perRay(sum.ballHits)},
            {"planes", perRay(sum.planes)},
            {"heights", perRay(sum.heights)},
            {"colours", perRay(sum.colours)},
            {"steps", perRay(sum.steps)},
            {"neighbours", perRay(sum.neighbours)}}}};
}

void printWork(const Measurement& measurement, const std::vector<SelectedView>& views) {
  const nlohmann::ordered_json work = workAsJson(measurement, views);
  fmt::print("work per frame: {:.0f} pairs\n", work["pairs"].get<double>());
  for (const char* unit : {"perSubTile", "perRay"}) {
    fmt::print("{:<12}", unit);
    for (const auto& [name, count] : work[unit].items()) fmt::print(" {} {:.3f}", name, count.get<double>());
    fmt::print("\n");
  }
}

void printMemory(const FrothAssetStatus& asset, const FrothViewStatus& view) {
  printParts("asset", asset.deviceBytes, {asset.memory, asset.memoryCount});
  printParts("view", view.deviceBytes, {view.memory, view.memoryCount});
}

nlohmann::ordered_json memoryAsJson(const FrothAssetStatus& asset, const FrothViewStatus& view) {
  return {{"asset", partsAsJson({asset.memory, asset.memoryCount})},
          {"view", partsAsJson({view.memory, view.memoryCount})}};
}

}  // namespace froth
