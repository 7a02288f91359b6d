// froth_flythrough: flies through a .froth asset, in a window or headless.
#include <CLI/CLI.hpp>

#include "samples/flythrough/headless.h"
#include "samples/flythrough/options.h"
#include "samples/flythrough/window.h"

namespace froth {
namespace {

// Waits for the first foam; `follower` goes on with the next ones.
Status follow(const std::filesystem::path& foam, const std::string& baker, std::unique_ptr<FoamFollower>& follower,
              FlythroughOptions& options) {
  Result<std::unique_ptr<FoamFollower>> made = FoamFollower::create(foam, baker);
  if (!made) return made.error();
  follower = std::move(*made);
  options.follower = follower.get();
  options.asset = follower->asset();
  return follower->waitForAsset();
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::FlythroughOptions options;
  std::string picture = "raster", baker = "froth";
  std::filesystem::path foam;
  CLI::App program{"Flies through a .froth asset."};
  CLI::Option* asset =
      program.add_option("ASSET", options.asset, "A .froth file, or its URL on a server that serves ranges");
  CLI::Option* followed =
      program
          .add_option(
              "--follow", foam,
              "In place of an asset: a foam (model.pt) that `froth train --show-every` writes; each one is baked "
              "and shown. Headless: a frame for each")
          ->excludes(asset);
  program.add_option("--baker", baker, "The program froth, where PATH does not lead to it")->needs(followed);
  program.add_option("--cameras", options.cameras, "Key frames (cameras.json) instead of the asset's own path");
  program
      .add_option("--renderer", picture,
                  "raster, walk, the difference of the two, or the levels of detail that the raster shows")
      ->capture_default_str()
      ->check(CLI::IsMember({"raster", "walk", "difference", "levels"}));
  program.add_flag("--counters", options.isCounting, "Window: count what the rays cost; slower");
  program
      .add_option("--target-ms", options.targetMilliseconds, "Window: draw less where frames take longer on the GPU")
      ->check(CLI::PositiveNumber);
  program.add_option("--budget", options.streaming.budget, "Of device memory [bytes, or with KB, MB, GB]; 0: no limit")
      ->transform(CLI::AsSizeValue(false));
  program.add_option("--detail", options.streaming.detail, "Levels of detail: errors may be 1 / DETAIL pixels large")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  froth::addRunOptions(program, options);
  CLI::Option* headless = program.get_option("--headless");
  program
      .add_flag("--settled", options.isSettled, "Headless: each frame waits until the levels that it wants are drawn")
      ->needs(headless);
  program.add_option("--json", options.json, "Headless: file for what streaming did, frame by frame")->needs(headless);
  return froth::runProgram("froth_flythrough", program, argc, argv, [&] {
    std::unique_ptr<froth::FoamFollower> follower;
    if (!foam.empty()) {
      if (froth::Status began = froth::follow(foam, baker, follower, options); !began) return began;
    }
    if (options.asset.empty()) {
      return froth::Status(froth::makeError(froth::ErrorKind::kUsage, "name an ASSET, or a foam to --follow"));
    }
    if (picture == "walk") options.picture = froth::Picture::kWalk;
    if (picture == "difference") options.picture = froth::Picture::kDifference;
    if (picture == "levels") options.picture = froth::Picture::kLevels;
    return options.isHeadless ? froth::flyHeadless(options) : froth::flyInWindow(options);
  });
}
