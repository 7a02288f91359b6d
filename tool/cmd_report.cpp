// froth report: error against run time and bytes, for one scene.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "baker/input/foam_input.h"
#include "base/output_file.h"
#include "base/version.h"
#include "format/read/asset_reader.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/report/report.h"
#include "measure/sweep/assemble.h"
#include "measure/sweep/features.h"
#include "measure/sweep/levels.h"
#include "measure/sweep/rays.h"
#include "measure/sweep/search.h"
#include "measure/sweep/slopes.h"
#include "reference/capture/view_selection.h"
#include "tool/commands.h"
#include "tool/options.h"

namespace froth {
namespace {

struct ReportOptions {
  std::filesystem::path input, output, photos;
  ViewOptions views;
  uint32_t viewCount = 6;
  double searchSeconds = 15;
  std::string device, credit, title;
  std::string command;             // with all options
  std::vector<std::string> knobs;  // empty: all
  bool isCpu = false, isWithoutImages = false, resumes = false, keepsWork = false;
  Rounds rounds;
};

constexpr const char* kRays = "rays";  // a word of --knobs

// Spread evenly over those of the file.
std::vector<SelectedView> spreadViews(const std::vector<SelectedView>& all, uint32_t count) {
  if (count == 0 || count >= all.size()) return all;
  std::vector<SelectedView> some;
  for (uint32_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

Result<std::string> hashFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::vector<char> buffer(1 << 20);
  while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || in.gcount() > 0) {
    XXH3_64bits_update(state.get(), buffer.data(), static_cast<size_t>(in.gcount()));
  }
  if (!in.eof()) return makeError(ErrorKind::kIo, "%s: cannot be read", path.c_str());
  return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

// What the figures of an interrupted report depend on.
Result<std::string> signatureOf(const ReportOptions& options, const CameraSet& cameras,
                                const std::vector<SelectedView>& views, const SweepRenderer& renderer) {
  const Result<std::string> input = hashFile(options.input);
  const Result<std::string> text = camerasText(cameras, options.views.cameras.string());
  if (!input) return input.error();
  if (!text) return text.error();
  std::string signature = fmt::format("version {} device '{}' driver '{}' input {} cameras {:016x} photos '{}' views",
                                      kVersion, renderer.device(), renderer.driver(), *input,
                                      XXH3_64bits(text->data(), text->size()), options.photos.string());
  for (const SelectedView& view : views) {
    signature += fmt::format(" {}:{}x{}", view.index, view.view.width, view.view.height);
  }
  return signature;
}

Result<std::unique_ptr<SweepRenderer>> createRenderer(const ReportOptions& options, const GpuDeviceOptions& device) {
  if (options.isCpu) return createCpuSweepRenderer();
  return createGpuSweepRenderer(device);
}

// Whether what is drawn can be walked: bakes of a foam can.
Result<bool> canWalk(const ReportOptions& options, bool hasFoam) {
  if (options.isCpu || hasFoam) return !options.isCpu;
  const Result<AssetReader> reader = AssetReader::open(options.input);
  if (!reader) return reader.error();
  return reader->manifest().hasWalkGraph;
}

// Those of --knobs, by their names up to a comma: "cutoff" is the cut-off with all else exact too.
Result<std::vector<Knob>> chooseKnobs(const ReportOptions& options, bool hasFoam, const Bench& bench,
                                      SweepReferences& references, const Progress& progress) {
  std::vector<Knob> knobs = drawingKnobs(bench.walks);
  if (!hasFoam && !options.isCpu) {
    const Result<std::vector<Knob>> levels = prepareLevels(bench, references, progress);
    if (!levels) return levels.error();
    knobs.insert(knobs.end(), levels->begin(), levels->end());
  }
  if (hasFoam) {
    for (Knob& knob : encodingKnobs()) {
      if (!options.isCpu || knob.method == Method::kRaster) knobs.push_back(std::move(knob));
    }
  }
  if (options.knobs.empty()) return knobs;
  const std::vector<std::string>& wanted = options.knobs;
  const auto nameOf = [](const Knob& knob) { return knob.sweep.knob.substr(0, knob.sweep.knob.find(',')); };
  for (const std::string& name : wanted) {
    if (name == "none" || name == kRays ||
        std::any_of(knobs.begin(), knobs.end(), [&](const Knob& knob) { return nameOf(knob) == name; })) {
      continue;
    }
    std::string names;
    for (const Knob& knob : knobs) {
      if (names.find(nameOf(knob)) == std::string::npos) names += " " + nameOf(knob);
    }
    return makeError(ErrorKind::kUsage, "--knobs: '%s' is not one of this input; give `none`, `rays` or some of%s",
                     name.c_str(), names.c_str());
  }
  std::erase_if(
      knobs, [&](const Knob& knob) { return std::find(wanted.begin(), wanted.end(), nameOf(knob)) == wanted.end(); });
  return knobs;
}

Status measureEach(const Bench& bench, PointList& points, const Progress& progress) {
  std::vector<PlannedPoint*> planned;
  for (PlannedPoint& point : points.all()) planned.push_back(&point);
  return measurePoints(bench, planned, progress);
}

// The search goes by times of one round. All times of the report are then of the same rounds: a front compares no
// others.
Status measureAll(const ReportOptions& options, const Bench& bench, const std::vector<Knob>& knobs, PointList& points,
                  const Progress& progress) {
  if (options.searchSeconds > 0) {
    Bench quick = bench;
    quick.rounds.count = 1;
    quick.rounds.frames = bench.rounds.frames / bench.rounds.count;
    if (Status measured = measureEach(quick, points, progress); !measured) return measured;
    if (Status searched = searchJointly(quick, knobs, options.searchSeconds, bench.rounds.seed, points, progress);
        !searched) {
      return searched;
    }
  }
  for (PlannedPoint& point : points.all()) point.hasTimes = false;
  return measureEach(bench, points, progress);
}

Status measureFeatures(const ReportOptions& options, const Bench& bench, const FoamInput& input,
                       const CameraSet& cameras, const GpuDeviceOptions& device, bool hasFoam, Report& result,
                       const Progress& progress) {
  const auto append = [&](const Result<std::vector<FeatureCost>>& costs) -> Status {
    if (!costs) return costs.error();
    result.features.insert(result.features.end(), costs->begin(), costs->end());
    return {};
  };
  if (options.isCpu) return {};
  if (hasFoam) {
    if (Status added = append(assetFeatures(bench, input, cameras, options.output / "work", progress)); !added) {
      return added;
    }
  }
  if (Status added = append(runtimeFeatures(bench, device, progress)); !added) return added;
  return append(bakeLeftOut(bench));
}

Status measureRays(const ReportOptions& options, const Bench& bench, const GpuDeviceOptions& device, Report& result,
                   const Progress& progress) {
  const bool isWanted = options.knobs.empty() || std::ranges::find(options.knobs, kRays) != options.knobs.end();
  if (!isWanted || !bench.walks) return {};
  Result<std::vector<RayCost>> costs = rayCosts(bench, device, progress);
  if (!costs) return costs.error();
  result.rays = std::move(*costs);
  return {};
}

void printSummary(const ReportOptions& options, const Report& result) {
  fmt::print("{}: {} configurations\n{}\n", (options.output / "report.html").string(), result.points.size(),
             result.choice);
  for (const Slope& slope : result.slopes) {
    if (slope.verdict == kVerdictAsDerived || slope.verdict == kVerdictFloor || slope.verdict == kVerdictTooFew) {
      continue;
    }
    fmt::print("flagged           {}: {}; {}\n", slope.what, slope.verdict, slope.note);
  }
}

// Where assets and log lie until the report is done.
Result<std::filesystem::path> makeWorkFolder(const ReportOptions& options) {
  const std::filesystem::path work = options.output / "work";
  std::error_code error;
  if (!options.resumes) std::filesystem::remove_all(work, error);
  std::filesystem::create_directories(work, error);
  if (error) return makeError(ErrorKind::kIo, "%s: cannot be made: %s", work.c_str(), error.message().c_str());
  return work;
}

Result<std::vector<Slope>> measureSlopes(const ReportOptions& options, const Bench& bench, const FoamInput& input,
                                         bool hasFoam, const std::vector<Knob>& knobs, const std::vector<Sweep>& sweeps,
                                         PointList& points, const Progress& progress) {
  Result<std::vector<Slope>> slopes = errorSlopes(bench, input.foam, knobs, sweeps, points);
  if (!slopes || options.isCpu || !options.knobs.empty()) return slopes;
  const Result<std::vector<Slope>> times = timeSlopes(bench, input, hasFoam, progress);
  if (!times) return times.error();
  slopes->insert(slopes->end(), times->begin(), times->end());
  return slopes;
}

Status runReport(const ReportOptions& options, const Progress& progress) {
  const Result<std::vector<SelectedView>> all = selectViews(options.views);
  if (!all) return all.error();
  const std::vector<SelectedView> views = spreadViews(*all, options.viewCount);
  const Result<CameraSet> cameras = readViews(options.views.cameras);
  if (!cameras) return cameras.error();
  const Result<std::filesystem::path> work = makeWorkFolder(options);
  if (!work) return work.error();
  const bool hasFoam = !isAssetPath(options.input);
  const Result<FoamInput> input = loadFoam(options.input, progress);
  if (!input) return input.error();

  GpuDeviceOptions device;
  device.device = options.device;
  device.lensClasses = lensClassesOf(views);
  Result<std::unique_ptr<SweepRenderer>> renderer = createRenderer(options, device);
  if (!renderer) return renderer.error();
  const Result<std::string> signature = signatureOf(options, *cameras, views, **renderer);
  if (!signature) return signature.error();
  Result<ReportLog> log = ReportLog::open(*work / "points.jsonl", *signature, options.resumes);
  if (!log) return log.error();
  Result<SweepReferences> references = SweepReferences::create(*input, views, options.photos, progress);
  if (!references) return references.error();

  BakeCache bakes(*input, *cameras, *work, hasFoam ? std::filesystem::path() : options.input);
  const Result<bool> walks = canWalk(options, hasFoam);
  if (!walks) return walks.error();
  const Bench bench{bakes, **renderer, *references, views, *log, options.rounds, *walks};
  const Result<std::vector<Knob>> knobs = chooseKnobs(options, hasFoam, bench, *references, progress);
  if (!knobs) return knobs.error();
  PointList points(options.isCpu);
  points.add(defaultConfig(), {}, true);
  Report result;
  result.sweeps = points.addSweeps(*knobs);
  takeOver(log->found(), points);
  if (Status measured = measureAll(options, bench, *knobs, points, progress); !measured) return measured;
  if (Status measured = measureFeatures(options, bench, *input, *cameras, device, hasFoam, result, progress);
      !measured) {
    return measured;
  }
  if (Status measured = measureRays(options, bench, device, result, progress); !measured) return measured;
  Result<std::vector<Slope>> slopes =
      measureSlopes(options, bench, *input, hasFoam, *knobs, result.sweeps, points, progress);
  if (!slopes) return slopes.error();
  result.slopes = std::move(*slopes);
  describeRun({options.title.empty() ? options.input.stem().string() : options.title, options.input.filename().string(),
               options.credit, options.command, hasFoam, options.isCpu},
              input->foam, bench, result);
  if (Status filled = fillReport(points, bench, !options.isWithoutImages, result); !filled) return filled;
  if (Status written = writeReport(options.output, result); !written) return written;
  printSummary(options, result);
  std::error_code ignored;
  if (!options.keepsWork) std::filesystem::remove_all(*work, ignored);
  return {};
}

// The command again, by its options as they were given.
std::string textOf(const CLI::App& command) {
  std::string text = "froth " + command.get_name();
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    if (!option->get_positional()) text += " " + option->get_name();
    if (option->get_items_expected_max() == 0) continue;  // a flag
    std::string values;
    for (const std::string& value : option->results()) values += (values.empty() ? "" : ",") + value;
    text += values.find_first_of(" '\"") == std::string::npos ? " " + values : fmt::format(" {:?}", values);
  }
  return text;
}

Status checkAndRunReport(const ReportOptions& options, const Progress& progress) {
  if (options.isCpu && !options.device.empty()) {
    return makeError(ErrorKind::kUsage, "--device %s: --cpu uses none; leave one out", options.device.c_str());
  }
  return runReport(options, progress);
}

}  // namespace

void addReportCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("report", "Error against run time and bytes of a scene: html, json, csv");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("INPUT", options->input, "A checkpoint; or a .froth file, as it is")->required();
  command->add_option("--cameras", options->views.cameras, kCamerasHelp)->required();
  command->add_option("-o,--output", options->output, "The folder to write")->required();
  command->add_option("--size", options->views.size, "Size of the images instead of the views' own")->type_name("WxH");
  command->add_option("--views", options->viewCount, "How many views are measured, spread over the file; 0: all")
      ->capture_default_str()
      ->check(countBetween(0, 100000));
  command->add_option("--photos", options->photos, "Folder of the photos, by the views' names");
  command
      ->add_option("--knobs", options->knobs,
                   "Turn only these, as in preset,cutoff; `rays`: what rays cost; `none`: parts of the scene alone")
      ->delimiter(',');
  addDurationOption(*command, "--search", options->searchSeconds, "For the search over several knobs at once", 0,
                    7 * 24 * 3600);
  command->add_option("--seed", options->rounds.seed, "Of that search, and of the order in each round of times")
      ->capture_default_str();
  command->add_option("--frames", options->rounds.frames, "Least frames that a time is of")
      ->capture_default_str()
      ->check(countBetween(1, 1000000));
  command->add_flag("--cpu", options->isCpu, "Times of the CPU renderer, without a GPU");
  command->add_option("--device", options->device, "Index or part of a name (`froth devices`)");
  command->add_flag("--no-images", options->isWithoutImages, "No pictures in report.html");
  command->add_option("--title", options->title, "Name of the scene; default: the input's");
  command->add_option("--credit", options->credit, "Whose photos and foam: shown at the foot");
  command->add_flag("--resume", options->resumes, "Go on where an interrupted report of the same folder stopped");
  command->add_flag("--keep-work", options->keepsWork,
                    "Leave the assets and the log of measurements in the folder's `work`");
  command->callback([&tool, options, command] {
    options->command = textOf(*command);
    tool.action = [&tool, options] { return checkAndRunReport(*options, tool.progress.callback()); };
  });
}

}  // namespace froth
