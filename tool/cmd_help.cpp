// froth help, man, completion: what --help tells, in other places.
#include <memory>

#include <fmt/format.h>

#include "tool/commands.h"
#include "tool/manual.h"

namespace froth {
namespace {

// Of an app that is not the one at hand: App::help() would tell of that.
std::string helpOf(const CLI::App& app, const std::string& name) {
  return app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal);
}

Status printHelp(const CLI::App& program, const std::string& topic) {
  if (topic.empty()) {
    fmt::print("{}", helpOf(program, "froth"));
    return {};
  }
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() != topic) continue;
    fmt::print("{}", helpOf(*command, "froth " + topic));
    return {};
  }
  return makeError(ErrorKind::kUsage, "help %s: no such command; `froth help` lists them", topic.c_str());
}

}  // namespace

void addHelpCommands(CLI::App& program, Tool& tool) {
  CLI::App* help = program.add_subcommand("help", "Tell what a command does, and its options");
  auto topic = std::make_shared<std::string>();
  help->add_option("COMMAND", *topic, "One of them; left out: all");
  help->callback([&program, &tool, topic] { tool.action = [&program, topic] { return printHelp(program, *topic); }; });

  CLI::App* man = program.add_subcommand("man", "Print the manual page: froth man > froth.1");
  man->callback([&program, &tool] {
    tool.action = [&program] {
      fmt::print("{}", manualPage(program));
      return Status();
    };
  });

  CLI::App* completion =
      program.add_subcommand("completion", "Print what bash sources to complete commands and options");
  completion->callback([&program, &tool] {
    tool.action = [&program] {
      fmt::print("{}", bashCompletion(program));
      return Status();
    };
  });
}

}  // namespace froth
