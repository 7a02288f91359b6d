// Who may include whom (architecture: "Folders"). Reads the sources as text.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/surroundings.h"

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // relative to the repository
  std::string target;  // as written between the quotes or brackets
};

bool isSource(const fs::path& path) {
  static const std::set<std::string> kExtensions{".h", ".hpp", ".c", ".cpp", ".cu", ".comp", ".glsl"};
  return kExtensions.contains(path.extension().string());
}

// What stands between the quotes or brackets of an #include line; empty for any other line.
std::string includedBy(const std::string& line) {
  const size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return {};
  const size_t word = line.find_first_not_of(" \t", hash + 1);
  if (word == std::string::npos || line.compare(word, 7, "include") != 0) return {};
  const size_t open = line.find_first_of("\"<", word);
  const size_t close = open == std::string::npos ? open : line.find_first_of("\">", open + 1);
  return close == std::string::npos ? std::string() : line.substr(open + 1, close - open - 1);
}

std::vector<Include> includesUnder(const std::string& folder) {
  const fs::path root = froth::test::sourceFolder();
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (!entry.is_regular_file() || !isSource(entry.path())) continue;
    std::ifstream text(entry.path());
    for (std::string line; std::getline(text, line);) {
      const std::string target = includedBy(line);
      if (!target.empty()) includes.push_back({fs::relative(entry.path(), root).string(), target});
    }
  }
  return includes;
}

bool startsWith(const std::string& text, const std::string& prefix) { return text.rfind(prefix, 0) == 0; }

// Names every include of `folder` that begins with one of the prefixes.
std::string offenders(const std::string& folder, const std::vector<std::string>& prefixes,
                      const std::string& exceptFolder = "-") {
  std::string found;
  for (const Include& include : includesUnder(folder)) {
    if (startsWith(include.file, exceptFolder)) continue;
    for (const std::string& prefix : prefixes) {
      if (startsWith(include.target, prefix)) found += include.file + " includes " + include.target + "\n";
    }
  }
  return found;
}

TEST(IncludeGraph, TheFormatIncludesNeitherBakerNorRuntime) {
  EXPECT_EQ(offenders("format", {"baker/", "runtime/", "froth/", "samples/", "vulkan/"}), "");
}

TEST(IncludeGraph, TheRuntimeIncludesNoBakerNoWindowNoImageLibraryNoWriter) {
  EXPECT_EQ(offenders("runtime", {"baker/", "samples/", "CGAL/", "tbb/", "GLFW/", "imgui", "png", "jpeglib", "stb",
                                  "nlohmann/", "fmt/", "spdlog/", "cuda", "format/asset_writer.h"}),
            "");
}

TEST(IncludeGraph, TheBakerLibrariesIncludeNoRuntimeAndNoSamples) {
  EXPECT_EQ(offenders("baker", {"runtime/", "froth/", "samples/", "vulkan/"}, "baker/tool/"), "");
}

TEST(IncludeGraph, TheFoamsMathematicsIncludesOnlyItself) {
  std::string found;
  const std::set<std::string> kAllowed{"cmath", "glm/glm.hpp", "prelude.h", "postlude.h"};
  for (const Include& include : includesUnder("shaders/foam")) {
    if (!kAllowed.contains(include.target)) found += include.file + " includes " + include.target + "\n";
  }
  EXPECT_EQ(found, "");
}

TEST(IncludeGraph, SamplesLinkOnlyWhatAGameWouldLink) {
  EXPECT_EQ(offenders("samples", {"baker/", "runtime/", "CGAL/", "tbb/"}), "");
}

TEST(IncludeGraph, ThePublicHeadersPullInVulkanCoreAlone) {
  std::set<std::string> targets;
  for (const Include& include : includesUnder("runtime/include")) {
    if (!startsWith(include.target, "froth/")) targets.insert(include.target);  // one of themselves
  }
  EXPECT_EQ(targets, (std::set<std::string>{"stdint.h", "vulkan/vulkan_core.h"}));
}

TEST(IncludeGraph, RoomsOfTheBakerHaveNoCycles) {
  std::map<std::string, std::set<std::string>> edges;
  const auto room = [](const std::string& path) { return path.substr(0, path.find('/', 6)); };
  for (const Include& include : includesUnder("baker")) {
    if (!startsWith(include.target, "baker/") || std::count(include.target.begin(), include.target.end(), '/') < 2) continue;
    if (room(include.file) != room(include.target)) edges[room(include.file)].insert(room(include.target));
  }
  // Remove rooms that depend on nothing left, until none is left or a cycle stays.
  for (bool removed = true; removed && !edges.empty();) {
    removed = false;
    for (auto it = edges.begin(); it != edges.end();) {
      std::erase_if(it->second, [&](const std::string& target) { return !edges.contains(target); });
      removed |= it->second.empty();
      it = it->second.empty() ? edges.erase(it) : std::next(it);
    }
  }
  std::string cycle;
  for (const auto& [from, to] : edges) cycle += from + " ";
  EXPECT_EQ(cycle, "");
}

}  // namespace
