// froth_flythrough: flies through a .froth asset, in a window or headless.
#include <cstdio>

#include <CLI/CLI.hpp>

#include "samples/flythrough/headless.h"
#include "samples/flythrough/options.h"
#include "samples/flythrough/window.h"

namespace {

constexpr int kExitFailed = 1, kExitUsage = 2, kExitBadInput = 3;

int exitCodeOf(froth::ErrorKind kind) {
  if (kind == froth::ErrorKind::kBadInput) return kExitBadInput;
  return kind == froth::ErrorKind::kUsage ? kExitUsage : kExitFailed;
}

std::string checkSize(const std::string& text) {
  unsigned width = 0, height = 0;
  char rest = 0;
  const bool isSize = std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) == 2;
  return isSize && width > 0 && height > 0 && width <= 16384 && height <= 16384
             ? std::string()
             : "'" + text + "' is not a size; write WIDTHxHEIGHT, each 1 to 16384, as in 1280x720";
}

}  // namespace

int main(int argc, char** argv) {
  froth::FlythroughOptions options;
  std::string size, picture = "raster";
  CLI::App program{"Flies through a .froth asset."};
  program.add_option("ASSET", options.asset, "A .froth file")->required();
  program.add_option("--cameras", options.cameras,
                     "Key frames (cameras.json) instead of the asset's own path");
  program.add_option("--size", size, "Size of window and frames")
      ->type_name("WxH")
      ->default_str("1280x720")
      ->check(CLI::Validator(checkSize, ""));
  program.add_option("--renderer", picture, "raster, walk, or the difference of the two")
      ->capture_default_str()
      ->check(CLI::IsMember({"raster", "walk", "difference"}));
  program.add_option("--device", options.device, "Index or part of a name");
  program.add_flag("--validate", options.validate, "Validation layers; fail on a message");
  program.add_flag("--counters", options.isCounting, "Window: count what the rays cost; slower");
  CLI::Option* frames = program.add_option("--frames", options.frames, "End after so many frames");
  CLI::Option* output = program.add_option("-o,--output", options.output, "Folder of frames and screenshots");
  CLI::Option* headless =
      program.add_flag("--headless", options.isHeadless, "No window: write frames and a contact sheet");
  headless->needs(frames)->needs(output);
  program.add_option("--compare", options.compare, "Headless: picture that the last frame must resemble")
      ->needs(headless);
  program.add_option("--min-psnr", options.minPsnr, "Headless: least PSNR of the comparison [dB]")
      ->capture_default_str()
      ->needs(headless);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "froth_flythrough: %s; see --help\n", error.what());
    return kExitUsage;
  }
  if (!size.empty()) std::sscanf(size.c_str(), "%ux%u", &options.extent.width, &options.extent.height);
  if (picture == "walk") options.picture = froth::Picture::kWalk;
  if (picture == "difference") options.picture = froth::Picture::kDifference;

  const froth::Status status = options.isHeadless ? froth::flyHeadless(options) : froth::flyInWindow(options);
  if (status) return 0;
  std::fprintf(stderr, "froth_flythrough: %s\n", status.error().message.c_str());
  return exitCodeOf(status.error().kind);
}
