// The sources of the repository as text.
#pragma once

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "tests/surroundings.h"

namespace froth::test {

struct Source {
  std::string path;  // relative to the repository
  std::vector<std::string> lines;
};

// Those of a folder of the repository and of the folders in it; "": of all but hidden ones and what is built.
inline std::vector<Source> sourcesUnder(const std::string& folder) {
  namespace fs = std::filesystem;
  static const std::set<std::string> kExtensions{".h", ".hpp", ".c", ".cpp", ".cu", ".glsl", ".comp", ".vert", ".frag"};
  const fs::path root = sourceFolder();
  std::vector<Source> sources;
  for (auto entry = fs::recursive_directory_iterator(root / folder); entry != fs::recursive_directory_iterator();
       ++entry) {
    const std::string name = entry->path().filename().string();
    const bool isOther = folder.empty() && entry.depth() == 0 && (name[0] == '.' || name == "build");
    if (isOther) entry.disable_recursion_pending();
    if (!entry->is_regular_file() || !kExtensions.contains(entry->path().extension().string())) continue;
    Source source{fs::relative(entry->path(), root).string(), {}};
    std::ifstream text(entry->path());
    for (std::string line; std::getline(text, line);) source.lines.push_back(line);
    sources.push_back(std::move(source));
  }
  return sources;
}

}  // namespace froth::test
