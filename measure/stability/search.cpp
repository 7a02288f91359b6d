#include "measure/stability/search.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "measure/stability/case_file.h"
#include "measure/stability/runs.h"

namespace froth {
namespace {

// A case on the device takes tens of milliseconds, and one that fails is bounded by 256 samples.
constexpr uint32_t kMostTries = 500;

// All forms of the `exact` bake, which keeps every number of the foam. Walks traced on the CPU are not judged: where
// sites coincide or the eye is on a vertex, their order is a tie that no image shows.
Result<std::optional<CaseFault>> judgeOnDevice(StabilityRunner& runner, const StiffCase& stiff) {
  const Result<PresetOutcome> outcome =
      runner.runOne(stiff, "exact", [](std::string_view, uint64_t, uint64_t) { return !isStopRequested(); });
  if (!outcome && outcome.error().kind == ErrorKind::kCancelled) return outcome.error();
  if (!outcome) return std::optional(CaseFault{"device: error", outcome.error().message});
  for (const SeenFault& seen : faultsOf(*outcome)) {
    if (seen.renderer == kTraceRenderer) continue;
    const auto run = std::find_if(outcome->renderers.begin(), outcome->renderers.end(),
                                  [&](const RendererOutcome& one) { return one.renderer == seen.renderer; });
    CaseFault fault{seen.renderer + ": " + seen.kind, seen.text};
    if (run != outcome->renderers.end()) fault.view = run->worstView, fault.x = run->worstX, fault.y = run->worstY;
    return std::optional(fault);
  }
  return std::optional<CaseFault>();
}

Status keepFound(FoundCase found, const std::string& drawnOn, const StabilitySearch& search,
                 const FiguresOutput& figures, ProgressPrinter& printer, nlohmann::ordered_json& list) {
  const std::string name = std::filesystem::path(found.shrunk.name).filename().string() + ".json";
  const std::filesystem::path path = search.folder / name;
  found.shrunk.analysis = drawnOn + " by the random search, and shrunk";
  if (Status written = writeCase(path, found.shrunk); !written) return written;
  list.push_back({{"file", path.string()},
                  {"kind", found.fault.kind},
                  {"what", found.fault.what},
                  {"cells", found.shrunk.foam.cellCount},
                  {"cellsBefore", found.cellsBefore}});
  printer.finishLine();
  if (!figures.wantsTable()) return {};
  fmt::print("{}: {}; {} of {} cells left; {}\n", path.string(), found.fault.kind, found.shrunk.foam.cellCount,
             found.cellsBefore, found.fault.what);
  std::fflush(stdout);
  return {};
}

Result<std::unique_ptr<StabilityRunner>> createRunner(GpuDeviceOptions device) {
  device.lensClasses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
  Result<std::unique_ptr<StabilityRunner>> runner = StabilityRunner::create(device);
  if (runner || !device.device.empty()) return runner;
  std::fprintf(stderr, "froth: the CPU judges alone: %s\n", runner.error().message.c_str());
  return std::unique_ptr<StabilityRunner>();
}

}  // namespace

Status runStabilitySearch(const StabilitySearch& search, const GpuDeviceOptions& device, const FiguresOutput& figures,
                          ProgressPrinter& printer) {
  std::error_code error;
  std::filesystem::create_directories(search.folder, error);
  if (error) return makeError(ErrorKind::kIo, "%s: cannot be made: %s", search.folder.c_str(), error.message().c_str());
  const Result<std::unique_ptr<StabilityRunner>> runner = createRunner(device);
  if (!runner) return runner.error();
  std::vector<CaseJudge> judges = {judgeOfReference()};
  if (*runner) judges.push_back([&](const StiffCase& stiff) { return judgeOnDevice(**runner, stiff); });

  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  SearchOptions options;
  options.seed = search.seed;
  options.seconds = search.seconds;
  options.mostTries = kMostTries;
  const std::string drawnOn =
      *runner ? fmt::format("found on {} ({})", (*runner)->device().name, (*runner)->device().driver)
              : "found on the CPU";
  options.onFound = [&](const FoundCase& found) { return keepFound(found, drawnOn, search, figures, printer, list); };
  const Result<SearchResult> result = searchCases(options, judgeByAll(std::move(judges)), printer.callback());
  if (!result) return result.error();
  const nlohmann::ordered_json summary = {{"seed", search.seed},
                                          {"device", *runner ? (*runner)->device().name : ""},
                                          {"driver", *runner ? (*runner)->device().driver : ""},
                                          {"tried", result->tried},
                                          {"failing", result->failing},
                                          {"found", list}};
  if (Status written = figures.write(summary); !written) return written;
  printer.finishLine();
  if (figures.wantsTable()) fmt::print("{} cases tried, {} fail\n", result->tried, result->failing);
  if (result->failing == 0) return {};
  return makeError(ErrorKind::kUnsupported,
                   "%llu of %llu random cases fail; the files in %s show it, and this is a fault of Froth",
                   static_cast<unsigned long long>(result->failing), static_cast<unsigned long long>(result->tried),
                   search.folder.c_str());
}

}  // namespace froth
