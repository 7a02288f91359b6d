// froth_flythrough: flies through a .froth asset, in a window or headless.
#include <CLI/CLI.hpp>

#include "samples/flythrough/headless.h"
#include "samples/flythrough/options.h"
#include "samples/flythrough/window.h"

int main(int argc, char** argv) {
  froth::FlythroughOptions options;
  std::string picture = "raster";
  CLI::App program{"Flies through a .froth asset."};
  program.add_option("ASSET", options.asset, "A .froth file")->required();
  program.add_option("--cameras", options.cameras, "Key frames (cameras.json) instead of the asset's own path");
  program.add_option("--renderer", picture, "raster, walk, or the difference of the two")
      ->capture_default_str()
      ->check(CLI::IsMember({"raster", "walk", "difference"}));
  program.add_flag("--counters", options.isCounting, "Window: count what the rays cost; slower");
  program
      .add_option("--target-ms", options.targetMilliseconds, "Window: draw less where frames take longer on the GPU")
      ->check(CLI::PositiveNumber);
  froth::addRunOptions(program, options);
  return froth::runProgram("froth_flythrough", program, argc, argv, [&] {
    if (picture == "walk") options.picture = froth::Picture::kWalk;
    if (picture == "difference") options.picture = froth::Picture::kDifference;
    return options.isHeadless ? froth::flyHeadless(options) : froth::flyInWindow(options);
  });
}
