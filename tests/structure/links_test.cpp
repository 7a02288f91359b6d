// What pages link to exists: files, headings, and paths between backticks.
#include <gtest/gtest.h>

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/surroundings.h"

namespace {

namespace fs = std::filesystem;

// Folders of the repository that hold what is built.
const std::set<std::string> kBuilt{"build", "out", "demo-out"};

// Paths that a page may name though they do not exist: names of stability cases that begin like a folder.
const std::vector<std::string> kNoPaths{"foam/placed_*"};

struct Page {
  fs::path path;                   // relative to the repository
  std::vector<std::string> lines;  // without code blocks, which are empty lines
};

Page readPage(const fs::path& path) {
  Page page{fs::relative(path, froth::test::sourceFolder()), {}};
  std::ifstream text(path);
  bool isCode = false;
  for (std::string line; std::getline(text, line);) {
    const size_t start = line.find_first_not_of(' ');
    const bool isFence = start != std::string::npos && line.compare(start, 3, "```") == 0;
    if (isFence) isCode = !isCode;
    page.lines.push_back(isCode || isFence ? std::string() : line);
  }
  return page;
}

// Every *.md, but for folders of what is built and of tools.
std::vector<Page> allPages() {
  std::vector<Page> pages;
  for (auto entry = fs::recursive_directory_iterator(froth::test::sourceFolder());
       entry != fs::recursive_directory_iterator(); ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory() && (name[0] == '.' || (entry.depth() == 0 && kBuilt.contains(name)))) {
      entry.disable_recursion_pending();
    }
    if (entry->is_regular_file() && entry->path().extension() == ".md") pages.push_back(readPage(entry->path()));
  }
  return pages;
}

// Runs of lines that are not empty, each as one line: links and code may go on in the next line.
std::vector<std::string> paragraphsOf(const Page& page) {
  std::vector<std::string> paragraphs{""};
  for (const std::string& line : page.lines) {
    if (line.empty() || line[0] == '|') paragraphs.emplace_back();
    paragraphs.back() += line + " ";
  }
  return paragraphs;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

std::string withoutCodeSpans(const std::string& line) { return std::regex_replace(line, std::regex("`[^`]*`"), "``"); }

// Bytes of a UTF-8 character by its first one.
size_t bytesOfCharacter(unsigned char first) { return first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4; }

// The anchor that GitHub gives a heading: links are their text, letters are lower case, spaces are hyphens, of all else
// only letters, digits, hyphens and underscores stay. Beyond ASCII, U+0080 to U+00BF, U+00D7 and U+2000 to U+2FFF count
// as signs, all else as letters.
std::string anchorOf(const std::string& heading) {
  const std::string text = std::regex_replace(heading, std::regex(R"(!?\[([^\]]*)\]\([^)]*\))"), "$1");
  std::string anchor;
  for (size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const size_t bytes = bytesOfCharacter(first);
    if (first < 0x80) {
      if (first == ' ') anchor += '-';
      if (std::isalnum(first) || first == '-' || first == '_') anchor += static_cast<char>(std::tolower(first));
    } else if (const bool isSign = first == 0xC2 || first == 0xE2 || text.compare(i, 2, "×") == 0; !isSign) {
      anchor += text.substr(i, bytes);
    }
    i += bytes;
  }
  return anchor;
}

// Of all headings; the second of two equal ones gets "-1".
std::set<std::string> anchorsOf(const Page& page) {
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  for (const std::string& line : page.lines) {
    std::smatch heading;
    if (!std::regex_match(line, heading, std::regex("#{1,6} +(.*?) *"))) continue;
    const std::string anchor = anchorOf(heading[1]);
    const int before = seen[anchor]++;
    anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
  }
  return anchors;
}

// What is wrong with a link of a page; empty: nothing.
std::string faultOf(const Page& page, const std::string& link) {
  if (link.find("://") != std::string::npos || link.starts_with("mailto:")) return {};
  const fs::path root = froth::test::sourceFolder();
  const size_t hash = link.find('#');
  const std::string file = link.substr(0, hash);
  const fs::path path = file.empty() ? root / page.path : (root / page.path).parent_path() / file;
  const std::string place = page.path.string() + ": (" + link + "): ";
  if (!fs::exists(path)) return place + "no such file\n";
  if (hash == std::string::npos || path.extension() != ".md") return {};
  return anchorsOf(readPage(path)).contains(link.substr(hash + 1)) ? "" : place + "no such heading\n";
}

// A text between backticks that names a file of the repository: at least one folder, the first one at the repository's
// root.
bool isRepositoryPath(const std::string& text) {
  if (!std::regex_match(text, std::regex(R"([\w.-]+(/[\w.*+-]+)+/?)"))) return false;
  const std::string folder = text.substr(0, text.find('/'));
  const bool isName = text.find("NAME") != std::string::npos;  // a name that the reader chooses
  const bool isCase = std::ranges::any_of(
      kNoPaths, [&](const std::string& path) { return fnmatch(path.c_str(), text.c_str(), 0) == 0; });
  return !isName && !isCase && !kBuilt.contains(folder) && fs::is_directory(froth::test::sourceFolder() / folder);
}

// Asterisks stand for any part of a file's name.
bool exists(const std::string& path) {
  const fs::path whole = froth::test::sourceFolder() / path;
  if (path.find('*') == std::string::npos) return fs::exists(whole);
  if (!fs::is_directory(whole.parent_path())) return false;
  return std::ranges::any_of(fs::directory_iterator(whole.parent_path()), [&](const fs::directory_entry& entry) {
    return fnmatch(whole.filename().c_str(), entry.path().filename().c_str(), 0) == 0;
  });
}

TEST(Links, LeadToFilesAndHeadings) {
  // [text](target) and ![text](target "title"); the text may hold an image, whose target is found by itself.
  const std::regex link(R"(\]\(<?([^)\s>]+)>?(?:\s+"[^"]*")?\))");
  std::string faults;
  for (const Page& page : allPages()) {
    for (const std::string& paragraph : paragraphsOf(page)) {
      for (const std::string& target : matches(withoutCodeSpans(paragraph), link)) faults += faultOf(page, target);
    }
  }
  EXPECT_EQ(faults, "");
}

TEST(Links, PathsBetweenBackticksExist) {
  std::string faults;
  for (const Page& page : allPages()) {
    for (const std::string& paragraph : paragraphsOf(page)) {
      for (const std::string& text : matches(paragraph, std::regex("`([^`]+)`"))) {
        if (isRepositoryPath(text) && !exists(text)) faults += page.path.string() + ": `" + text + "`: no such file\n";
      }
    }
  }
  EXPECT_EQ(faults, "");
}

TEST(Links, PagesAreFound) {
  const std::vector<Page> pages = allPages();
  const auto has = [&](const char* path) {
    return std::ranges::any_of(pages, [&](const Page& page) { return page.path == path; });
  };
  EXPECT_TRUE(has("README.md"));
  EXPECT_TRUE(has("docs/EMBEDDING.md"));
  EXPECT_TRUE(has("docs/reports/README.md"));
}

TEST(Links, AnchorsAreThoseOfGitHub) {
  EXPECT_EQ(anchorOf("Device loss"), "device-loss");
  EXPECT_EQ(anchorOf("CPU queries ([froth_query.h](../runtime/include/froth/froth_query.h))"),
            "cpu-queries-froth_queryh");
  EXPECT_EQ(anchorOf("Codecs, `lz` & α"), "codecs-lz--α");
  EXPECT_EQ(anchorsOf({"a.md", {"# One", "## One", "text", "####### Seven"}}), (std::set<std::string>{"one", "one-1"}));
}

TEST(Links, FaultsAreNamed) {
  const Page page{"docs/none.md", {}};
  EXPECT_EQ(faultOf(page, "EMBEDDING.md#link"), "");
  EXPECT_EQ(faultOf(page, "https://example.org/none"), "");
  EXPECT_EQ(faultOf(page, "none_at_all.md"), "docs/none.md: (none_at_all.md): no such file\n");
  EXPECT_EQ(faultOf(page, "EMBEDDING.md#none"), "docs/none.md: (EMBEDDING.md#none): no such heading\n");
  EXPECT_TRUE(isRepositoryPath("baker/none.cpp"));
  EXPECT_FALSE(exists("baker/none.cpp"));
  EXPECT_TRUE(exists("measure/stability/cases/*_cases.cpp"));
  EXPECT_FALSE(isRepositoryPath("eyes/on_detail_site"));
}

}  // namespace
