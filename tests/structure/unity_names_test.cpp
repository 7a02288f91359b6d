// Unity builds compile any files of a library together, and others as files are added: names in anonymous namespaces
// meet there. Reads the sources as text.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

#include "tests/structure/sources.h"

namespace froth::test {
namespace {

// The constants and types that a file's anonymous namespaces declare outside of functions.
std::set<std::string> namesIn(const Source& source) {
  static const std::regex kConstant(R"(\b(k[A-Z]\w*)(\[.*?\])? ?[={])"), kType(R"(^(struct|class|enum class) (\w+).*)");
  std::set<std::string> names;
  bool isAnonymous = false;
  for (const std::string& line : source.lines) {
    if (line == "namespace {") isAnonymous = true;
    if (line == "}  // namespace") isAnonymous = false;
    if (!isAnonymous) continue;
    std::smatch type;
    if (std::regex_match(line, type, kType)) names.insert(type[2]);
    if (line.rfind("constexpr ", 0) != 0 && line.rfind("const ", 0) != 0) continue;
    const std::string code = line.substr(0, line.find("//"));
    for (std::sregex_iterator i(code.begin(), code.end(), kConstant); i != std::sregex_iterator(); ++i) {
      names.insert((*i)[1]);
    }
  }
  return names;
}

TEST(UnityNames, AreThoseOfOneFileOfTheirRoom) {
  size_t count = 0;
  for (const char* room : {"base", "foam", "reference", "baker", "trainer", "measure", "runtime", "host", "tool"}) {
    std::map<std::string, std::string> owners;
    for (const Source& source : sourcesUnder(room)) {
      if (!source.path.ends_with(".cpp")) continue;
      for (const std::string& name : namesIn(source)) {
        ++count;
        const auto [owner, isNew] = owners.emplace(name, source.path);
        EXPECT_TRUE(isNew) << name << ": in " << owner->second << " and in " << source.path << "; rename one";
      }
    }
  }
  EXPECT_GT(count, 500u);  // they are found
}

}  // namespace
}  // namespace froth::test
