// Who may include whom (docs/ARCHITECTURE.md). Reads the sources as text.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/structure/sources.h"
#include "tests/surroundings.h"

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // relative to the repository
  std::string target;  // as written between the quotes or brackets
};

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
  std::vector<Include> includes;
  for (const froth::test::Source& source : froth::test::sourcesUnder(folder)) {
    for (const std::string& line : source.lines) {
      const std::string target = includedBy(line);
      if (!target.empty()) includes.push_back({source.path, target});
    }
  }
  return includes;
}

bool startsWith(const std::string& text, const std::string& prefix) { return text.rfind(prefix, 0) == 0; }

// What each room may include of the repository, besides itself: folders, or a file.
const std::map<std::string, std::vector<std::string>> kRooms{
    {"base", {}},
    {"shaders", {}},
    {"format", {"base"}},
    {"runtime", {"base", "format", "shaders"}},
    {"host", {"base", "runtime/include"}},
    {"foam", {"base", "shaders/foam"}},
    {"reference", {"base", "foam", "shaders/foam"}},
    {"baker", {"base", "format", "foam", "reference", "trainer/cpu", "trainer/step", "shaders/foam"}},
    {"trainer", {"base", "foam", "reference", "shaders/foam"}},
    {"measure", {"base", "format", "foam", "reference", "baker", "host", "runtime/include", "shaders/foam"}},
    {"tool",
     {"base", "format", "foam", "reference", "trainer", "baker", "host", "measure", "runtime/include", "shaders/foam"}},
    {"samples", {"base", "host", "runtime/include", "shaders/froth_walk.glsl"}},
};

// Each includes only those in front of it.
const std::vector<std::string> kRuntimeFloors{"runtime/include", "runtime/pool",  "runtime/files",  "runtime/heap",
                                              "runtime/device",  "runtime/jobs",  "runtime/reads",  "runtime/query",
                                              "runtime/stream",  "runtime/asset", "runtime/render", "runtime/walk",
                                              "runtime/context", "runtime/api"};

bool isIn(const std::string& path, const std::string& folder) { return startsWith(path, folder + "/"); }

// The file of the repository that an include names; empty: it is another's, or is generated.
std::string resolve(const Include& include) {
  const fs::path root = froth::test::sourceFolder();
  for (const fs::path& from :
       {root, root / "runtime/include", root / "shaders", root / fs::path(include.file).parent_path()}) {
    const fs::path path = (from / include.target).lexically_normal();
    if (fs::is_regular_file(path)) return fs::relative(path, root).string();
  }
  return {};
}

// Names every include of `folder` that begins with one of the prefixes.
std::string offenders(const std::string& folder, const std::vector<std::string>& prefixes) {
  std::string found;
  for (const Include& include : includesUnder(folder)) {
    for (const std::string& prefix : prefixes) {
      if (startsWith(include.target, prefix)) found += include.file + " includes " + include.target + "\n";
    }
  }
  return found;
}

TEST(IncludeGraph, EachRoomIncludesOnlyThoseBelowIt) {
  std::string found;
  for (const auto& [room, below] : kRooms) {
    for (const Include& include : includesUnder(room)) {
      const std::string target = resolve(include);
      const bool isAllowed =
          target.empty() || isIn(target, room) ||
          std::ranges::any_of(below, [&](const std::string& path) { return target == path || isIn(target, path); });
      if (!isAllowed) found += include.file + " includes " + target + "\n";
    }
  }
  EXPECT_EQ(found, "");
}

TEST(IncludeGraph, EveryFolderOfSourcesIsARoom) {
  const std::set<std::string> kOthers{"build", "tests", "docs", "scripts", "cmake"};
  for (const auto& entry : fs::directory_iterator(froth::test::sourceFolder())) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || name[0] == '.' || kOthers.contains(name)) continue;
    EXPECT_TRUE(kRooms.contains(name)) << name;
  }
}

TEST(IncludeGraph, TheFloorsOfTheRuntimeIncludeOnlyThoseBelow) {
  const auto floorOf = [](const std::string& path) {
    return std::ranges::find_if(kRuntimeFloors, [&](const std::string& floor) { return isIn(path, floor); }) -
           kRuntimeFloors.begin();
  };
  std::string found;
  for (const Include& include : includesUnder("runtime")) {
    const std::string target = resolve(include);
    if (isIn(target, "runtime") && floorOf(target) > floorOf(include.file)) {
      found += include.file + " includes " + target + "\n";
    }
  }
  EXPECT_EQ(found, "");
  for (const auto& entry : fs::directory_iterator(fs::path(froth::test::sourceFolder()) / "runtime")) {
    if (!entry.is_directory()) continue;
    const std::string folder = "runtime/" + entry.path().filename().string();
    EXPECT_TRUE(std::ranges::count(kRuntimeFloors, folder)) << folder;
  }
}

TEST(IncludeGraph, TheRuntimeIncludesNoWindowNoImageLibraryNoWriter) {
  EXPECT_EQ(offenders("runtime", {"CGAL/", "tbb/", "GLFW/", "imgui", "png", "jpeglib", "stb", "nlohmann/", "fmt/",
                                  "spdlog/", "cuda", "format/write/", "base/atomic_file", "base/image/",
                                  "base/temporary_file", "base/progress"}),
            "");
}

TEST(IncludeGraph, ReadersAndWritersOfTheFormatAreApart) {
  EXPECT_EQ(offenders("format/read", {"format/write/"}), "");
  EXPECT_EQ(offenders("format/write", {"format/read/"}), "");
}

TEST(IncludeGraph, TheFoamsMathematicsIncludesOnlyItself) {
  std::string found;
  const std::set<std::string> kAllowed{"cmath", "glm/glm.hpp", "prelude.h", "postlude.h"};
  for (const Include& include : includesUnder("shaders/foam")) {
    if (!kAllowed.contains(include.target)) found += include.file + " includes " + include.target + "\n";
  }
  EXPECT_EQ(found, "");
}

TEST(IncludeGraph, SamplesLinkOnlyWhatAGameWouldLink) { EXPECT_EQ(offenders("samples", {"CGAL/", "tbb/"}), ""); }

TEST(IncludeGraph, ThePublicHeadersPullInVulkanCoreAlone) {
  std::set<std::string> targets;
  for (const Include& include : includesUnder("runtime/include")) {
    if (!startsWith(include.target, "froth/")) targets.insert(include.target);  // one of themselves
  }
  EXPECT_EQ(targets, (std::set<std::string>{"stdint.h", "vulkan/vulkan_core.h"}));
}

TEST(IncludeGraph, FoldersHaveNoCycles) {
  std::map<std::string, std::set<std::string>> edges;
  const auto folderOf = [](const std::string& path) { return fs::path(path).parent_path().string(); };
  for (const auto& [room, below] : kRooms) {
    for (const Include& include : includesUnder(room)) {
      const std::string target = resolve(include);
      if (!target.empty() && folderOf(include.file) != folderOf(target)) {
        edges[folderOf(include.file)].insert(folderOf(target));
      }
    }
  }
  // Remove folders that depend on nothing left, or on which nothing depends, until none is left or a cycle stays.
  for (bool removed = true; removed;) {
    std::set<std::string> targets;
    for (auto& [from, to] : edges) {
      std::erase_if(to, [&](const std::string& target) { return !edges.contains(target); });
      targets.insert(to.begin(), to.end());
    }
    removed = std::erase_if(edges,
                            [&](const auto& edge) { return edge.second.empty() || !targets.contains(edge.first); }) > 0;
  }
  std::string cycle;
  for (const auto& [from, to] : edges) cycle += from + " ";
  EXPECT_EQ(cycle, "");
}

}  // namespace
