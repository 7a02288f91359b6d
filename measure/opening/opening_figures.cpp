#include "measure/opening/opening_figures.h"

#include <string>

#include <fmt/format.h>

#include "measure/figures.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

struct NamedMark {
  const char* name;
  OpeningMark Opening::*mark;
};

constexpr NamedMark kMarks[] = {
    {"head", &Opening::head}, {"ready", &Opening::ready}, {"first", &Opening::first}, {"settled", &Opening::settled}};

Json markAsJson(const OpeningMark& mark) {
  return {{"ms", mark.milliseconds},
          {"frames", mark.frames},
          {"reads", mark.reads},
          {"bytes", mark.bytes},
          {"processMs", mark.processMs}};
}

Json runAsJson(const Opening& opening) {
  Json json{{"contextMs", opening.contextMs},
            {"precompileMs", opening.precompileMs},
            {"cachedShare", opening.cachedShare ? Json(*opening.cachedShare) : Json(nullptr)}};
  for (const NamedMark& named : kMarks) json[named.name] = markAsJson(opening.*named.mark);
  json["longestUpdateMs"] = opening.longestUpdateMs;
  json["diskBytes"] = opening.diskBytes;
  return json;
}

// Of all runs but the first, which meets a driver that has done nothing yet; of that one where there is no other.
Percentiles timesOf(const Openings& openings, OpeningMark Opening::*mark) {
  std::vector<double> times;
  for (size_t i = openings.runs.size() > 1 ? 1 : 0; i < openings.runs.size(); ++i) {
    times.push_back((openings.runs[i].*mark).milliseconds);
  }
  return percentilesOf(times);
}

std::string describeCache(const Opening& opening) {
  return opening.cachedShare ? fmt::format("{:.0f} %", 100 * *opening.cachedShare) : "unknown";
}

}  // namespace

void printOpenings(const Openings& openings, const OpeningOptions& options) {
  fmt::print("{} on {} ({}), {} cells in {} chunks of all levels, {}x{}\n", options.asset, openings.deviceName,
             openings.driverName, openings.asset.cellCount, openings.asset.chunkCount, options.view.width,
             options.view.height);
  fmt::print("{:>3} {:>8} {:>9} {:<8} {:>10} {:>7} {:>7} {:>9} {:>9}\n", "run", "cached", "pipelines", "up to", "ms",
             "frames", "reads", "MiB", "CPU ms");
  for (size_t i = 0; i < openings.runs.size(); ++i) {
    const Opening& opening = openings.runs[i];
    std::string start =
        fmt::format("{:>3} {:>8} {:>9.2f}", i + 1, describeCache(opening), opening.contextMs + opening.precompileMs);
    for (const NamedMark& named : kMarks) {
      const OpeningMark& mark = opening.*named.mark;
      fmt::print("{:<22} {:<8} {:>10.2f} {:>7} {:>7} {:>9.2f} {:>9.2f}\n", start, named.name, mark.milliseconds,
                 mark.frames, mark.reads, static_cast<double>(mark.bytes) / kMebi, mark.processMs);
      start.clear();
    }
    fmt::print("{:<22} longest frothUpdate up to the first image {:.2f} ms, {:.2f} MiB from a disk\n", "",
               opening.longestUpdateMs, static_cast<double>(opening.diskBytes) / kMebi);
  }
  const Percentiles first = timesOf(openings, &Opening::first), settled = timesOf(openings, &Opening::settled);
  fmt::print("{}: first image {:.2f} ms (worst {:.2f}), settled {:.2f} ms (worst {:.2f})\n",
             openings.runs.size() > 1 ? "median of all runs but the first" : "one run", first.median, first.worst,
             settled.median, settled.worst);
}

Json openingsAsJson(const Openings& openings, const OpeningOptions& options) {
  Json runs = Json::array();
  for (const Opening& opening : openings.runs) runs.push_back(runAsJson(opening));
  Json json{{"input", options.asset},
            {"device", openings.deviceName},
            {"driver", openings.driverName},
            {"renderer", infoOf(options.render.method).name},
            {"width", options.view.width},
            {"height", options.view.height},
            {"cells", openings.asset.cellCount},
            {"chunks", openings.asset.chunkCount},
            {"keepsCache", options.keepsCache},
            {"runs", runs}};
  for (const NamedMark& named : kMarks) {
    json[std::string(named.name) + "Ms"] = percentilesAsJson(timesOf(openings, named.mark));
  }
  return json;
}

}  // namespace froth
