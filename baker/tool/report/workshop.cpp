#include "baker/tool/report/workshop.h"

#include <atomic>
#include <chrono>
#include <optional>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <xxhash.h>

#include "baker/synth/simplify.h"
#include "baker/synth/synth.h"
#include "baker/tool/asset_sink.h"
#include "baker/tool/progress_printer.h"

namespace froth {
namespace {

// One bake leaves cores idle in its short stages; each needs memory for its chunks.
constexpr uint32_t kSmallFoam = 250'000;  // cells
constexpr size_t kBakesAtOnce = 4;

// The foam that a configuration bakes where it is not the input itself.
Result<std::optional<Foam>> transformFoam(const Foam& foam, const ReportConfig& config) {
  std::optional<Foam> changed;
  if (config.detailsKept > 0 && config.detailsKept < foam.detailCount)
    changed = withFewerDetailSites(foam, config.detailsKept);
  if (config.copies > 1) {
    Result<Foam> tiled = tileFoam(changed ? *changed : foam, config.copies);
    if (!tiled) return tiled.error();
    changed = std::move(*tiled);
  }
  return changed;
}

}  // namespace

Workshop::Workshop(const FoamInput& input, const CameraSet& cameras, std::filesystem::path folder)
    : input_(input), cameras_(cameras), folder_(std::move(folder)) {}

std::filesystem::path Workshop::assetOf(const ReportConfig& config) const {
  const std::string key = encodingKey(config);
  return folder_ / fmt::format("{:016x}.froth", XXH3_64bits(key.data(), key.size()));
}

double Workshop::secondsOf(const ReportConfig& config) const {
  const std::lock_guard lock(mutex_);
  const auto found = done_.find(encodingKey(config));
  return found == done_.end() ? 0 : found->second.seconds;
}

std::vector<LeftOut> Workshop::leftOutOf(const ReportConfig& config) const {
  const std::lock_guard lock(mutex_);
  const auto found = done_.find(encodingKey(config));
  return found == done_.end() ? std::vector<LeftOut>{} : found->second.leftOut;
}

Status Workshop::bakeOne(const ReportConfig& config, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const Result<std::optional<Foam>> changed = transformFoam(input_.foam, config);
  if (!changed) return changed.error();
  BakeOptions options;
  options.preset = "custom";
  options.knobs = config.knobs;
  options.walkGraph = config.walkGraph;
  options.steiner = config.steiner;
  options.nearRatio = input_.nearRatio;
  options.nearDepth = input_.nearDepth;
  options.measure = false;
  options.source = "froth report";
  if (config.copies == 1) options.cameras = &cameras_;
  AssetFileSink file(assetOf(config));
  const Result<BakeResult> baked = bakeFoam(*changed ? **changed : input_.foam, options, file.sink(), progress);
  if (!baked) return baked.error();
  if (const Result<uint64_t> bytes = file.finish(baked->contents); !bytes) return bytes.error();
  const std::lock_guard lock(mutex_);
  done_[encodingKey(config)] = {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                                baked->leftOut};
  return {};
}

Status Workshop::bake(std::span<const ReportConfig> configs, const Progress& progress) {
  std::vector<ReportConfig> missing;
  std::set<std::string> seen;
  for (const ReportConfig& config : configs) {
    if (seen.insert(encodingKey(config)).second && !std::filesystem::exists(assetOf(config))) missing.push_back(config);
  }
  std::atomic<size_t> next = 0, finished = 0;
  std::vector<Status> statuses(missing.size());
  std::atomic<bool> isStopped = false;
  const Progress quiet = [&](std::string_view, uint64_t, uint64_t) { return !isStopped; };
  const auto work = [&] {
    for (size_t i = next++; i < missing.size() && !isStopped; i = next++) {
      statuses[i] = bakeOne(missing[i], quiet);
      if (!statuses[i]) isStopped = true;
      ++finished;
    }
  };
  std::vector<std::jthread> others;
  const size_t atOnce = input_.foam.cellCount <= kSmallFoam ? std::min(kBakesAtOnce, missing.size()) : 1;
  for (size_t i = 0; i < atOnce; ++i) others.emplace_back(work);
  while (finished < missing.size() && !isStopped) {
    if (!report(progress, "bake", finished, missing.size())) isStopped = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  others.clear();  // joins
  for (const Status& status : statuses) {
    if (!status) return status;
  }
  return isStopped ? Status(stoppedError()) : Status();
}

}  // namespace froth
