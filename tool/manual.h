// The program's options as a man page and as completions of a shell: the same text as --help.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace froth {

// A page of section 1, in man's macros.
std::string manualPage(const CLI::App& program);

// A script that bash sources: commands, their options, file names elsewhere.
std::string bashCompletion(const CLI::App& program);

}  // namespace froth
