#include "measure/marked_text.h"

#include <string_view>

#include "base/atomic_file.h"

namespace froth {
namespace {

constexpr std::string_view kEnd = "<!-- end -->\n";

std::string beginOf(const std::string& section) {
  return "<!-- " + section + "made by `froth stability --markdown`: begin -->\n";
}

}  // namespace

Result<std::string> readMarked(const std::filesystem::path& path, const std::vector<std::string>& sections) {
  std::string text;
  if (!std::filesystem::exists(path)) {
    for (const std::string& section : sections) text.append(beginOf(section)).append(kEnd);
    return text;
  }
  const Result<std::vector<uint8_t>> bytes = readFile(path);
  if (!bytes) return bytes.error();
  text.assign(bytes->begin(), bytes->end());
  for (const std::string& section : sections) {
    const std::string line = beginOf(section);
    const size_t begin = text.find(line);
    if (begin != std::string::npos && text.find(kEnd, begin) != std::string::npos) continue;
    return makeError(ErrorKind::kBadInput,
                     "%s: the lines '%s' and '<!-- end -->' are not there; put them where the tables go", path.c_str(),
                     line.substr(0, line.size() - 1).c_str());
  }
  return text;
}

void replaceMarked(std::string& text, const std::string& section, const std::string& inside) {
  const std::string line = beginOf(section);
  const size_t from = text.find(line) + line.size();
  text.replace(from, text.find(kEnd, from) - from, inside);
}

}  // namespace froth
