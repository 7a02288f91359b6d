#include "host/command_line.h"

#include <cstdio>

#include <CLI/CLI.hpp>

namespace froth {
namespace {

constexpr int kExitFailed = 1, kExitUsage = 2, kExitBadInput = 3;

int exitCodeOf(ErrorKind kind) {
  if (kind == ErrorKind::kBadInput) return kExitBadInput;
  return kind == ErrorKind::kUsage ? kExitUsage : kExitFailed;
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

CLI::Option* addSizeOption(CLI::App& program, const char* name, VkExtent2D& extent, const char* description) {
  const auto readSize = [&extent](const std::string& text) {
    std::sscanf(text.c_str(), "%ux%u", &extent.width, &extent.height);
  };
  return program.add_option_function<std::string>(name, readSize, description)
      ->type_name("WxH")
      ->check(CLI::Validator(checkSize, ""));
}

void addRunOptions(CLI::App& program, RunOptions& options) {
  addSizeOption(program, "--size", options.extent, "Size of window and frames")->default_str("1280x720");
  program.add_option("--device", options.device, "Index or part of a name");
  program.add_flag("--validate", options.validate, "Validation layers; fail on a message");
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
}

int runProgram(const char* name, CLI::App& program, int argc, char** argv, const std::function<Status()>& run) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s: %s; see --help\n", name, error.what());
    return kExitUsage;
  }
  const Status status = run();
  if (status) return 0;
  std::fprintf(stderr, "%s: %s\n", name, status.error().message.c_str());
  return exitCodeOf(status.error().kind);
}

}  // namespace froth
