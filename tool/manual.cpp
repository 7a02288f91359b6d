#include "tool/manual.h"

#include <vector>

#include <fmt/format.h>

#include "base/version.h"

namespace froth {
namespace {

std::vector<const CLI::App*> commandsOf(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

// A leading dot or quote would be a macro, a hyphen a soft one.
std::string escaped(const std::string& text) {
  std::string result = text.empty() || (text[0] != '.' && text[0] != '\'') ? "" : "\\&";
  for (const char c : text) {
    if (c == '\\' || c == '-') result += '\\';
    result += c;
  }
  return result;
}

// "-o, --output FILE"
std::string headOf(const CLI::Option& option) {
  std::string head;
  for (const std::string& name : option.get_snames()) head += fmt::format("{}-{}", head.empty() ? "" : ", ", name);
  for (const std::string& name : option.get_lnames()) head += fmt::format("{}--{}", head.empty() ? "" : ", ", name);
  if (head.empty()) head = option.get_name(true);
  return option.get_type_size() > 0 && !option.get_positional() ? head + " " + option.get_type_name() : head;
}

std::string describe(const CLI::Option& option) {
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += fmt::format(" (default: {})", option.get_default_str());
  if (option.get_required()) text += " (required)";
  return text;
}

std::string optionList(const CLI::App& app) {
  std::string page;
  for (const CLI::Option* option : app.get_options()) {
    page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", escaped(headOf(*option)), escaped(describe(*option)));
  }
  return page;
}

}  // namespace

std::string manualPage(const CLI::App& program) {
  std::string page = fmt::format(".TH FROTH 1 \"\" \"Froth {}\" \"Froth\"\n.SH NAME\nfroth \\- {}\n", kVersion,
                                 escaped(program.get_description()));
  page += ".SH SYNOPSIS\n.B froth\n.I COMMAND\n[options]\n.SH OPTIONS\n" + optionList(program);
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : commandsOf(program)) {
    page += fmt::format(".SS \"froth {}\"\n{}\n{}", command->get_name(), escaped(command->get_description()),
                        optionList(*command));
  }
  return page + ".SH EXIT STATUS\n0: well. 1: failed. 2: wrong usage. 3: bad input.\n";
}

std::string bashCompletion(const CLI::App& program) {
  std::string names, cases;
  for (const CLI::App* command : commandsOf(program)) {
    names += command->get_name() + " ";
    std::string options;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) options += "--" + name + " ";
    }
    cases += fmt::format("    {}) options='{}' ;;\n", command->get_name(), options);
  }
  return "_froth() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} options=''\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         names +
         "' -- \"$word\"))\n"
         "    return\n"
         "  fi\n"
         "  case ${COMP_WORDS[1]} in\n" +
         cases + "    help) options='" + names +
         "' ;;\n"
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
         "}\n"
         "complete -o default -F _froth froth\n";
}

}  // namespace froth
