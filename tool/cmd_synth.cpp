// froth synth: foams made procedurally, the gallery's ray-traced ground truth, and tilings for scale.
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "baker/bake/bake.h"
#include "baker/input/foam_input.h"
#include "baker/synth/simplify.h"
#include "baker/synth/synth.h"
#include "base/output_file.h"
#include "base/text.h"
#include "foam/checkpoint/checkpoint.h"
#include "format/write/asset_writer.h"
#include "reference/capture/view_selection.h"
#include "tool/commands.h"
#include "tool/options.h"
#include "tool/view_output.h"

namespace froth {
namespace {

constexpr const char* kGallery = "gallery";
constexpr const char* kTile = "tile";

struct SynthCommandOptions {
  SynthOptions synth;
  std::filesystem::path output;
  bool isFlat = false, isPlain = false;

  std::filesystem::path tileSource;
  uint32_t tileCount = 0;

  ViewOptions views;  // of the ground truth; without cameras a foam is made
  uint32_t samples = 16;
};

Status writeFoamFile(const std::filesystem::path& path, const Foam& foam, const Progress& progress) {
  if (Status written = exportCheckpoint(path, foam, progress); !written) return written;
  fmt::print("{}: {} cells\n", path.string(), foam.cellCount);
  return {};
}

Status runNamedScene(const SynthCommandOptions& options, const Progress& progress) {
  Result<Foam> foam = synthesizeFoam(options.synth, progress);
  if (!foam) return foam.error();
  if (options.isFlat) *foam = withoutViewDependence(*foam);
  if (options.isPlain) *foam = withoutDisplacement(*foam);
  if (Status written = writeFoamFile(options.output, *foam, progress); !written) return written;
  if (options.synth.name != kGallery) return {};

  std::filesystem::path cameras = options.output;
  cameras.replace_extension(".cameras.json");
  if (Status written = writeCameras(cameras, galleryCameras()); !written) return written;
  fmt::print("{}: test views and a flight path\n", cameras.string());
  return {};
}

Status runGroundTruth(const SynthCommandOptions& options, const Progress& progress) {
  const Result<std::vector<SelectedView>> views = selectViews(options.views);
  if (!views) return views.error();
  const Result<std::vector<std::filesystem::path>> paths = outputPaths(options.views, *views, options.output);
  if (!paths) return paths.error();
  for (size_t i = 0; i < views->size(); ++i) {
    const Result<Image> image = traceGallery((*views)[i].view, options.samples, progress);
    if (!image) return image.error();
    if (Status written = writeOutput((*paths)[i], *image); !written) return written;
    fmt::print("{}\n", (*paths)[i].string());
  }
  return {};
}

// An asset tiles into an asset with its own near limits; bakes of a checkpoint get the usual ones.
Status runTile(const SynthCommandOptions& options, const Progress& progress) {
  Result<FoamInput> input = loadFoam(options.tileSource, progress);
  if (!input) return input.error();
  const Result<Foam> tiled = tileFoam(input->foam, options.tileCount);
  if (!tiled) return tiled.error();
  input->foam = {};  // a tiling can be as large as memory allows
  if (!isAssetPath(options.output)) return writeFoamFile(options.output, *tiled, progress);

  BakeOptions bake;
  bake.nearRatio = input->nearRatio;
  bake.nearDepth = input->nearDepth;
  bake.source = fmt::format("{} x {}", printable(options.tileSource.filename().string()), options.tileCount);
  const Result<BakeResult> baked = bakeFoam(*tiled, bake, progress);
  if (!baked) return baked.error();
  if (Status written = writeAsset(options.output, baked->contents); !written) return written;
  fmt::print("{}: {} cells\n", options.output.string(), tiled->cellCount);
  return {};
}

Status checkOptions(const CLI::App& command, const SynthCommandOptions& options) {
  const bool isTile = options.synth.name == kTile;
  const bool isGroundTruth = command.count("--ground-truth") > 0;
  if (isTile != (command.count("--of") > 0) || isTile != (command.count("--count") > 0)) {
    return makeError(ErrorKind::kUsage, "--of INPUT and --count N belong to `froth synth tile`, which needs both");
  }
  if (isGroundTruth && options.synth.name != kGallery) {
    return makeError(ErrorKind::kUsage,
                     "--ground-truth: only the gallery has an analytic scene; use `froth synth gallery`");
  }
  if (!isGroundTruth && command.count("--samples") + command.count("--view") + command.count("--size") > 0) {
    return makeError(ErrorKind::kUsage, "--samples, --view and --size belong to --ground-truth");
  }
  if ((isTile || isGroundTruth) && command.count("--cells") + command.count("--seed") +
                                           command.count("--flat-colours") + command.count("--plain-faces") >
                                       0) {
    return makeError(ErrorKind::kUsage,
                     "--cells, --seed, --flat-colours and --plain-faces belong to a foam that is made from nothing");
  }
  if ((options.synth.name != kGallery || isGroundTruth) &&
      command.count("--detail-sites") + command.count("--lobes") > 0) {
    return makeError(ErrorKind::kUsage, "--detail-sites and --lobes belong to the gallery's foam");
  }
  if (!isGroundTruth && !isTile && isAssetPath(options.output)) {
    return makeError(ErrorKind::kUsage, "-o %s: a synthetic foam is a checkpoint; name a .pt and `froth bake` it",
                     options.output.c_str());
  }
  return {};
}

Status runSynth(const CLI::App& command, const SynthCommandOptions& options, const Progress& progress) {
  if (Status good = checkOptions(command, options); !good) return good;
  if (!options.views.cameras.empty()) return runGroundTruth(options, progress);
  if (Status writable = checkWritable(options.output); !writable) return writable;
  if (options.synth.name == kTile) return runTile(options, progress);
  return runNamedScene(options, progress);
}

}  // namespace

void addSynthCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("synth", "Make a foam procedurally");
  auto options = std::make_shared<SynthCommandOptions>();
  std::vector<std::string> names = synthNames();
  names.push_back(kTile);
  command->add_option("NAME", options->synth.name, "Scene, or `tile`")->required()->check(CLI::IsMember(names));
  command->add_option("-o,--output", options->output, "Checkpoint to write; a folder or image for --ground-truth")
      ->required();
  command->add_option("--cells", options->synth.cellCount, "Cells to make; 0: as many as suit the scene")
      ->check(countBetween(0, std::numeric_limits<uint32_t>::max()));
  command->add_option("--detail-sites", options->synth.detailCount, "gallery: detail sites per cell; default 8")
      ->check(countBetween(1, 32));
  command->add_option("--lobes", options->synth.lobeCount, "gallery: lobes per detail site; default 8")
      ->check(countBetween(1, 32));
  command->add_flag("--flat-colours", options->isFlat, "The same colours from everywhere");
  command->add_flag("--plain-faces", options->isPlain, "No displacement");
  command->add_option("--seed", options->synth.seed, "Seed of what is random")->capture_default_str();
  command->add_option("--of", options->tileSource, "tile: the checkpoint or asset to copy");
  command->add_option("--count", options->tileCount, "tile: number of copies")
      ->check(countBetween(1, std::numeric_limits<uint32_t>::max()));
  command->add_option("--ground-truth", options->views.cameras,
                      "gallery: ray trace the scene itself for these cameras");
  command->add_option("--samples", options->samples, "Samples per pixel of the truth")
      ->capture_default_str()
      ->check(countBetween(1, std::numeric_limits<uint32_t>::max()));
  addViewOptions(*command, options->views);
  command->callback([&tool, command, options] {
    tool.action = [&tool, command, options] { return runSynth(*command, *options, tool.progress.callback()); };
  });
}

}  // namespace froth
