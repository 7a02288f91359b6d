// The subcommands of `froth`. Each add...Command() declares one: its options, and what runs when it is
// chosen.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "base/progress_printer.h"
#include "base/result.h"

namespace froth {

struct Tool {
  ProgressPrinter progress;
  std::function<Status()> action;  // of the chosen subcommand; set by parsing
};

void addSynthCommand(CLI::App& program, Tool& tool);
void addTrainCommand(CLI::App& program, Tool& tool);
void addEvaluateCommand(CLI::App& program, Tool& tool);
void addBakeCommand(CLI::App& program, Tool& tool);
void addRenderCommand(CLI::App& program, Tool& tool);
void addInfoCommand(CLI::App& program, Tool& tool);
void addVerifyCommand(CLI::App& program, Tool& tool);
void addCompareCommand(CLI::App& program, Tool& tool);
void addBenchCommand(CLI::App& program, Tool& tool);
void addCompareBenchCommand(CLI::App& program, Tool& tool);
void addReportCommand(CLI::App& program, Tool& tool);
void addStabilityCommand(CLI::App& program, Tool& tool);
void addDevicesCommand(CLI::App& program, Tool& tool);
void addHelpCommands(CLI::App& program, Tool& tool);  // after all others

}  // namespace froth
