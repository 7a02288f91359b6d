// What clang-format does not know of the layout (CONTRIBUTING.md "Rules of the code"): braces and lengths. Reads the
// sources as text.
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/structure/sources.h"

namespace froth::test {
namespace {

constexpr size_t kMostLines = 400;
constexpr size_t kMostLinesOfMinimal = 149;  // what an engine writes to show a foam fits on a few screens

// What follows the condition of an `if`, `for` or `while` that begins at lines[at], on the line where it ends.
std::string afterCondition(const std::vector<std::string>& lines, size_t at) {
  static const std::regex kTextAndComments(R"("(\\.|[^"\\])*"|'(\\.|[^'\\])'|//.*)");
  int depth = 0;
  for (; at < lines.size(); ++at) {
    const std::string code = std::regex_replace(lines[at], kTextAndComments, "");
    for (size_t i = 0; i < code.size(); ++i) {
      if (code[i] == '(') ++depth;
      if (code[i] == ')' && --depth == 0) return code.substr(i + 1);
    }
  }
  return {};
}

TEST(Layout, BodiesOnLinesOfTheirOwnHaveBraces) {
  const std::regex head(R"(^\s*(\} )?(else )?(if|if constexpr|for|while) ?\(.*)"), bareElse(R"(^\s*(\} )?else\s*$)");
  std::string found;
  for (const Source& source : sourcesUnder("")) {
    for (size_t i = 0; i < source.lines.size(); ++i) {
      const bool isHead = std::regex_match(source.lines[i], head);
      const bool lacksBrace = std::regex_match(source.lines[i], bareElse) ||
                              (isHead && std::regex_match(afterCondition(source.lines, i), std::regex(R"(\s*)")));
      if (lacksBrace) found += source.path + ":" + std::to_string(i + 1) + ": " + source.lines[i] + "\n";
    }
  }
  EXPECT_EQ(found, "");
}

TEST(Layout, FilesAreShort) {
  std::string found;
  for (const Source& source : sourcesUnder("")) {
    const size_t count = source.lines.size();
    if (count > kMostLines) found += source.path + ": " + std::to_string(count) + " lines\n";
  }
  EXPECT_EQ(found, "");
}

TEST(Layout, TheSmallestProgramStaysUnder150Lines) {
  size_t count = 0;
  for (const Source& source : sourcesUnder("samples/minimal")) {
    if (source.path == "samples/minimal/main.c") count = source.lines.size();
  }
  EXPECT_GT(count, 0);
  EXPECT_LE(count, kMostLinesOfMinimal);
}

}  // namespace
}  // namespace froth::test
