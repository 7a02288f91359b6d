// froth stability: the stiff set through all renderers and presets, against derived bounds.
#include <fnmatch.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "baker/input/foam_input.h"
#include "measure/figures.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/stability/case_file.h"
#include "measure/stability/cases/stiff_case.h"
#include "measure/stability/runs.h"
#include "measure/stability/search.h"
#include "measure/stability/table.h"
#include "reference/capture/view_selection.h"
#include "tool/commands.h"
#include "tool/options.h"

namespace froth {
namespace {

struct StabilityOptions {
  std::filesystem::path input, cameras;  // empty: built-in cases alone
  std::filesystem::path replay;          // a folder of case files, in place of the built-in cases; empty: none
  std::filesystem::path markdown;
  std::string only = "*";
  std::vector<std::string> presets = stabilityPresets();
  GpuDeviceOptions device;
  FiguresOutput figures;
  StabilitySearch search;
};

// Views of a user's own that its cases start from.
constexpr size_t kInputViews = 2;

Result<std::vector<StiffCase>> casesOfInput(const StabilityOptions& options, const Progress& progress) {
  const Result<FoamInput> input = loadFoam(options.input, progress);
  if (!input) return input.error();
  Result<CameraSet> cameras = readViews(options.cameras);
  if (!cameras) return cameras.error();
  std::vector<View>& views = cameras->views;
  views.resize(std::min(views.size(), kInputViews));
  for (View& view : views) {
    view.nearRatio = view.nearRatio.value_or(input->nearRatio);
    view.nearDepth = view.nearDepth.value_or(input->nearDepth);
  }
  return casesOfFoam(input->foam, views);
}

// Found cases, in the order of their names: files as --search writes them.
Result<std::vector<StiffCase>> readFoundCases(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  if (error) return makeError(ErrorKind::kIo, "%s: cannot be listed: %s", folder.c_str(), error.message().c_str());
  if (files.empty()) return makeError(ErrorKind::kUsage, "%s: no case files (*.json) in it", folder.c_str());
  std::sort(files.begin(), files.end());
  std::vector<StiffCase> cases;
  for (const std::filesystem::path& file : files) {
    Result<StiffCase> found = readCase(file);
    if (!found) return found.error();
    cases.push_back(std::move(*found));
  }
  return cases;
}

Result<std::vector<StiffCase>> selectCases(const StabilityOptions& options, const Progress& progress) {
  if (!options.replay.empty()) return readFoundCases(options.replay);
  std::vector<StiffCase> cases = builtInCases();
  if (!options.input.empty()) {
    Result<std::vector<StiffCase>> own = casesOfInput(options, progress);
    if (!own) return own.error();
    cases.insert(cases.end(), std::make_move_iterator(own->begin()), std::make_move_iterator(own->end()));
  }
  std::erase_if(cases,
                [&](const StiffCase& stiff) { return fnmatch(options.only.c_str(), stiff.name.c_str(), 0) != 0; });
  if (!cases.empty()) return cases;
  return makeError(ErrorKind::kUsage, "--only %s: no case has such a name; docs/reports/stability.md lists them",
                   options.only.c_str());
}

Result<std::vector<JudgedCase>> runCases(const StabilityOptions& options, std::vector<StiffCase> cases,
                                         StabilityRunner& runner, Tool& tool) {
  const Progress progress = tool.progress.callback();
  // Found cases are found in `exact`, which keeps every number of the foam.
  const std::vector<std::string> presets = options.replay.empty() ? options.presets : std::vector<std::string>{"exact"};
  std::vector<JudgedCase> judged;
  for (StiffCase& stiff : cases) {
    if (!report(progress, "stability: " + stiff.name, judged.size(), cases.size())) return stoppedError();
    // Stages within a case are too short to be told; they only ask whether to go on.
    Result<CaseOutcome> outcome =
        runner.run(stiff, presets, [](std::string_view, uint64_t, uint64_t) { return !isStopRequested(); });
    if (!outcome) return outcome.error();
    judged.push_back({std::move(stiff), std::move(*outcome)});
    tool.progress.finishLine();
    if (options.figures.wantsTable()) printCase(judged.back());
  }
  return judged;
}

Status runStability(const StabilityOptions& options, Tool& tool) {
  if (options.search.seconds > 0) {
    return runStabilitySearch(options.search, options.device, options.figures, tool.progress);
  }
  if (!options.markdown.empty()) {
    if (Status writable = checkMarkdown(options.markdown); !writable) return writable;
  }
  Result<std::vector<StiffCase>> cases = selectCases(options, tool.progress.callback());
  if (!cases) return cases.error();
  GpuDeviceOptions device = options.device;
  for (const StiffCase& stiff : *cases) {
    for (const View& view : stiff.views) device.lensClasses |= lensClassesOf(view);
  }
  const Result<std::unique_ptr<StabilityRunner>> runner = StabilityRunner::create(device);
  if (!runner) return runner.error();
  const Result<std::vector<JudgedCase>> judged = runCases(options, std::move(*cases), **runner, tool);
  if (!judged) return judged.error();

  const auto count = [&](CaseVerdict verdict) {
    return std::count_if(judged->begin(), judged->end(),
                         [&](const JudgedCase& one) { return one.outcome.verdict == verdict; });
  };
  const auto failures = static_cast<size_t>(count(CaseVerdict::kFails));
  nlohmann::ordered_json figures = {{"device", (*runner)->device().name},
                                    {"driver", (*runner)->device().driver},
                                    {"counts",
                                     {{"cases", judged->size()},
                                      {"within", count(CaseVerdict::kWithin)},
                                      {"refused", count(CaseVerdict::kRefused)},
                                      {"known", count(CaseVerdict::kKnown)},
                                      {"beyond", failures}}}};
  for (const JudgedCase& one : *judged) figures["cases"].push_back(caseAsJson(one));
  if (Status written = options.figures.write(figures); !written) return written;
  if (!options.markdown.empty()) {
    if (Status written = writeMarkdown(options.markdown, *judged, (*runner)->device()); !written) return written;
  }
  if (failures == 0) return {};
  return makeError(ErrorKind::kUnsupported, "%zu of %zu cases fall short of their bounds; this is a fault of Froth",
                   failures, judged->size());
}

void addSearchOptions(CLI::App& command, StabilitySearch& search) {
  CLI::Option* duration =
      addDurationOption(command, "--search", search.seconds,
                        "Hunt so long for random cases that fail, in place of the built-in set", 0.05, 1e7);
  command.add_option("--seed", search.seed, "Of the random cases")->check(countBetween(0, UINT64_MAX))->needs(duration);
  command.add_option("-o,--output", search.folder, "Folder for a file of each found case; the current one if left out")
      ->needs(duration);
  for (const char* other : {"INPUT", "--replay", "--cameras", "--only", "--presets", "--markdown"}) {
    duration->excludes(command.get_option(other));
  }
}

}  // namespace

void addStabilityCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand(
      "stability", "Stiff and extreme cases through all renderers and presets, against derived bounds");
  auto options = std::make_shared<StabilityOptions>();
  options->device.validate = true;
  CLI::Option* input =
      command->add_option("INPUT", options->input, "A checkpoint or asset, whose transformations are run too");
  CLI::Option* cameras =
      command->add_option("--cameras", options->cameras, "Views of INPUT, as bake takes them; the first two are taken");
  input->needs(cameras);
  cameras->needs(input);
  CLI::Option* only = command->add_option("--only", options->only, "Only cases whose name fits the pattern: 'sites/*'");
  CLI::Option* replay = command->add_option(
      "--replay", options->replay,
      "Run the case files of a folder, as --search writes them, by their exact bakes, in place of the built-in set");
  CLI::Option* presets = command->add_option("--presets", options->presets, "Only these presets, with commas between");
  presets->delimiter(',')->check(CLI::IsMember(stabilityPresets()))->default_str("all");
  replay->type_name("DIR")->excludes(input)->excludes(only)->excludes(presets);
  command->add_option("--device", options->device.device, "Index or part of a name from `froth devices`");
  command->add_flag_callback(
      "--no-validation", [options] { options->device.validate = false; },
      "Where no validation layers are installed; indices are checked all the same");
  command->add_option("--markdown", options->markdown, "Put the tables into this file, between its markers")
      ->excludes(only)
      ->excludes(presets)
      ->excludes(replay);
  addSearchOptions(*command, options->search);
  addFiguresOption(*command, options->figures);
  command->callback([&tool, options] { tool.action = [&tool, options] { return runStability(*options, tool); }; });
}

}  // namespace froth
