#include "measure/sweep/bake_cache.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <optional>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "baker/bake/asset_sink.h"
#include "baker/synth/simplify.h"
#include "baker/synth/synth.h"
#include "base/progress_printer.h"

namespace froth {
namespace {

// One bake leaves cores idle in its short stages; each needs memory for its chunks.
constexpr uint32_t kSmallFoam = 250'000;  // cells
constexpr size_t kBakesAtOnce = 8;

// The foam that a configuration bakes where it is not the input itself.
Result<std::optional<Foam>> transformFoam(const Foam& foam, const ReportConfig& config) {
  std::optional<Foam> changed;
  if (config.detailsKept > 0 && config.detailsKept < foam.detailCount) {
    changed = withFewerDetailSites(foam, config.detailsKept);
  }
  if (config.copies > 1) {
    Result<Foam> tiled = tileFoam(changed ? *changed : foam, config.copies);
    if (!tiled) return tiled.error();
    changed = std::move(*tiled);
  }
  return changed;
}

}  // namespace

BakeCache::BakeCache(const FoamInput& input, const CameraSet& cameras, std::filesystem::path folder)
    : BakeCache(input, cameras, std::move(folder), {}) {}

BakeCache::BakeCache(const FoamInput& input, const CameraSet& cameras, std::filesystem::path folder,
                     std::filesystem::path asset)
    : input_(input), cameras_(cameras), folder_(std::move(folder)), asset_(std::move(asset)) {}

std::filesystem::path BakeCache::assetOf(const ReportConfig& config) const {
  if (!asset_.empty()) return asset_;
  const std::string key = encodingKey(config);
  return folder_ / fmt::format("{:016x}.froth", XXH3_64bits(key.data(), key.size()));
}

std::filesystem::path BakeCache::recordPath(const ReportConfig& config) const {
  return assetOf(config).replace_extension(".json");
}

Result<BakeRecord> BakeCache::recordOf(const ReportConfig& config) const {
  BakeRecord record;
  if (!asset_.empty()) return record;
  const std::filesystem::path path = recordPath(config);
  std::ifstream in(path);
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("seconds") || !json.contains("leftOut") || !json.contains("largestErrors")) {
    return makeError(ErrorKind::kBadInput, "%s: is not a record of a bake; leave out --resume to begin anew",
                     path.c_str());
  }
  record.seconds = json["seconds"].get<double>();
  for (const auto& [what, bytes] : json["leftOut"].items()) record.leftOut.push_back({what, bytes.get<uint64_t>()});
  for (const auto& [attribute, error] : json["largestErrors"].items()) {
    record.largestErrors[attribute] = error.get<double>();
  }
  return record;
}

Status BakeCache::bakeOne(const ReportConfig& config, const Progress& progress) const {
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
  if (config.hasCameras) options.cameras = &cameras_;
  AssetFileSink file(assetOf(config), WriteProtected::kRefuse);
  const Result<BakeResult> baked = bakeFoam(*changed ? **changed : input_.foam, options, file.sink(), progress);
  if (!baked) return baked.error();
  if (const Result<uint64_t> bytes = file.finish(baked->contents); !bytes) return bytes.error();
  nlohmann::json leftOut = nlohmann::json::object();
  for (const LeftOut& one : baked->leftOut) leftOut[one.what] = one.savedBytes;
  nlohmann::json largest = nlohmann::json::object();
  for (const AttributeError& one : baked->contents.errors) largest[one.name] = one.max;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::ofstream out(recordPath(config));
  out << nlohmann::json{{"seconds", seconds}, {"leftOut", leftOut}, {"largestErrors", largest}}.dump() << std::flush;
  if (!out) return makeError(ErrorKind::kIo, "%s: cannot be written", recordPath(config).c_str());
  return {};
}

Status BakeCache::bake(std::span<const ReportConfig> configs, const Progress& progress) {
  if (!asset_.empty()) return {};
  std::vector<ReportConfig> missing;
  std::set<std::string> seen;
  for (const ReportConfig& config : configs) {
    if (seen.insert(encodingKey(config)).second && !std::filesystem::exists(recordPath(config))) {
      missing.push_back(config);
    }
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
