// Checks of numbers on the command line; their messages say what was found and what to give.
#pragma once

#include <cstdint>

#include <CLI/CLI.hpp>

namespace froth {

// A finite number in [least, most].
CLI::Validator numberBetween(double least, double most);
// The same in whole numbers, written in digits.
CLI::Validator countBetween(uint64_t least, uint64_t most);

}  // namespace froth
