// Figures of a command: a table for people, JSON for machines.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "base/percentiles.h"
#include "base/result.h"

namespace froth {

inline constexpr double kMebi = 1 << 20;  // bytes

// `--json` prints the figures as JSON on stdout instead of the table; `--json=FILE` writes them to a file
// beside it.
struct FiguresOutput {
  std::string target;  // empty: no JSON; "-": stdout; else a file

  bool wantsTable() const { return target != "-"; }
  Status write(const nlohmann::ordered_json& figures) const;
};

nlohmann::ordered_json percentilesAsJson(const Percentiles& figures);

}  // namespace froth
