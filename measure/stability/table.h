// What `froth stability` writes of its outcomes.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "measure/stability/runs.h"

namespace froth {

struct JudgedCase {
  StiffCase stiff;
  CaseOutcome outcome;
};

void printCase(const JudgedCase& judged);
nlohmann::ordered_json caseAsJson(const JudgedCase& judged);

// Fails where writeMarkdown() would, before long work; makes the folder of images.
Status checkMarkdown(const std::filesystem::path& path);
// Puts tables and published forms between the file's markers, in place of what is there, and a figure into images/
// beside it; makes the file if it does not exist.
Status writeMarkdown(const std::filesystem::path& path, const std::vector<JudgedCase>& cases,
                     const HostDeviceInfo& device);

}  // namespace froth
