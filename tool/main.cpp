// The program `froth`: parses arguments, runs one command, turns its error into a message and an exit code.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "base/text.h"
#include "base/version.h"
#include "tool/commands.h"
#include "tool/exit_codes.h"

namespace {

int runAction(froth::Tool& tool) {
  const froth::Status status = tool.action();
  tool.progress.finishLine();
  if (status && std::fflush(stdout) != 0) {
    std::fprintf(stderr, "froth: standard output: cannot be written: %s; figures are missing\n", std::strerror(errno));
    return froth::kExitFailed;
  }
  if (status) return froth::kExitWell;
  std::fprintf(stderr, "froth: %s\n", froth::printable(status.error().message).c_str());  // it may quote a file
  return froth::exitCodeOf(status.error().kind);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"Bakes, renders and measures radiance foams."};
  program.require_subcommand(0, 1);  // none is told below: CLI11 would not name a misspelt one
  program.fallthrough();             // --quiet is accepted after the subcommand too
  program.set_version_flag("--version", froth::kVersion);

  froth::Tool tool;
  program.add_flag_callback(
      "-q,--quiet", [&tool] { tool.progress.setQuiet(); }, "No progress on stderr");
  froth::addSynthCommand(program, tool);
  froth::addTrainCommand(program, tool);
  froth::addEvaluateCommand(program, tool);
  froth::addBakeCommand(program, tool);
  froth::addRenderCommand(program, tool);
  froth::addInfoCommand(program, tool);
  froth::addVerifyCommand(program, tool);
  froth::addCompareCommand(program, tool);
  froth::addBenchCommand(program, tool);
  froth::addCompareBenchCommand(program, tool);
  froth::addReportCommand(program, tool);
  froth::addStabilityCommand(program, tool);
  froth::addDevicesCommand(program, tool);
  froth::addHelpCommands(program, tool);

  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "froth: %s; `froth --help` and `froth COMMAND --help` list what there is\n", error.what());
    return froth::kExitUsage;
  }

  if (!tool.action) {
    std::fprintf(stderr, "froth: a command is needed; `froth --help` lists them\n");
    return froth::kExitUsage;
  }
  froth::stopOnInterrupt();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told like any other failed write
  try {
    return runAction(tool);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "froth: out of memory; work on fewer cells or pixels, or on a machine with more\n");
  } catch (const std::exception& error) {  // third-party code that throws; Froth itself returns its errors
    std::fprintf(stderr, "froth: internal error: %s\n", error.what());
  }
  return froth::kExitFailed;
}
