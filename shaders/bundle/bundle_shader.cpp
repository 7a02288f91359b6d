// Makes one file of a shader and all that it includes, for engines: every name in it that is neither GLSL's nor one of
// the public structures' fields gets the prefix froth_, so that it clashes with no name and no macro of theirs.
//
//   froth_bundle_shader FOLDER SOURCE OUTPUT
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// clang-format off
const std::set<std::string> kGlslWords = {
    "if", "else", "for", "while", "break", "continue", "return", "struct", "const", "in", "out", "inout", "precise", "true",
    "false", "void", "bool", "int", "uint", "float", "vec2", "vec3", "vec4", "uvec2", "uvec3", "uvec4", "ivec3",
    "layout", "set", "binding", "uniform", "buffer", "readonly", "std140", "std430", "buffer_reference", "buffer_reference_align",
    "abs", "atomicAdd", "bitCount", "clamp", "cos", "dot", "exp", "exp2", "floatBitsToUint", "floor", "max", "min", "normalize", "pow", "sin",
    "sqrt", "tan", "uintBitsToFloat",
    "x", "y", "z", "w", "xy", "yz", "xyz", "rgb", "r", "g", "b", "a"};
const std::set<std::string> kDirectiveWords = {"define", "undef", "if", "ifdef", "ifndef", "elif", "else", "endif", "defined",
                                               "extension", "require"};
const std::set<std::string> kPublicFields = {"origin", "direction", "tMin", "tMax", "apex", "mask", "hint", "distance", "normal",
                                             "instance", "chunk", "cell", "userId", "status", "ray", "hit"};
// clang-format on

bool startsWith(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }
bool isWordCharacter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::string prefixed(const std::string& word, bool isDirective) {
  const bool isKept = kGlslWords.contains(word) || kPublicFields.contains(word) ||
                      (isDirective && kDirectiveWords.contains(word)) || startsWith(word, "froth") ||
                      startsWith(word, "Froth") || startsWith(word, "FROTH") || startsWith(word, "GL_") ||
                      std::isdigit(static_cast<unsigned char>(word[0]));
  return isKept ? word : "froth_" + word;
}

// Comments stay.
std::string prefixLine(const std::string& line) {
  const size_t code = std::min(line.find("//"), line.size());
  const size_t first = line.find_first_not_of(' ');
  const bool isDirective = first != std::string::npos && line[first] == '#';
  std::string result;
  for (size_t i = 0; i < code;) {
    size_t end = i;
    while (end < code && isWordCharacter(line[end])) ++end;
    if (end == i) {
      result += line[i++];
      continue;
    }
    result += prefixed(line.substr(i, end - i), isDirective);
    i = end;
  }
  return result + line.substr(code);
}

class Bundle {
 public:
  explicit Bundle(fs::path root) : root_(std::move(root)) {}

  void add(const fs::path& file) {
    std::ifstream text(file);
    if (!text) throw std::runtime_error(file.string() + ": cannot be read");
    bool isFirstDirective = true;
    for (std::string line; std::getline(text, line);) {
      const bool isDirective = startsWith(line, "#");
      // Files with a guard are wanted once.
      if (isDirective && isFirstDirective && startsWith(line, "#ifndef") && !guards_.insert(line).second) return;
      isFirstDirective = isFirstDirective && !isDirective;
      if (isDirective && decide(line)) continue;
      if (!isActive()) continue;
      if (startsWith(line, "#include \"")) {
        const std::string name = line.substr(10, line.rfind('"') - 10);
        add(fs::exists(root_ / name) ? root_ / name : file.parent_path() / name);
        continue;
      }
      output_ += prefixLine(line) + "\n";
    }
  }

  const std::string& output() const { return output_; }

 private:
  struct Condition {
    bool isKnown, isActive;
  };

  bool isActive() const {
    for (const Condition& condition : conditions_) {
      if (!condition.isActive) return false;
    }
    return true;
  }

  // Whether a directive is answered here: it is one about C++ or about whose shader this is.
  bool decide(const std::string& line) {
    if (startsWith(line, "#if")) {
      const bool isCpp = line == "#if defined(__cplusplus)", isNotCpp = line == "#if !defined(__cplusplus)";
      const bool isWalk = line == "#if defined(FROTH_WALK)", isNotWalk = line == "#if !defined(FROTH_WALK)";
      const bool isKnown = isCpp || isNotCpp || isWalk || isNotWalk;
      conditions_.push_back({isKnown, !isKnown || isNotCpp || isWalk});
      return isKnown;
    }
    if (startsWith(line, "#else")) {
      Condition& last = conditions_.back();
      if (last.isKnown) last.isActive = !last.isActive;
      return last.isKnown;
    }
    if (!startsWith(line, "#endif")) return false;
    const bool isKnown = conditions_.back().isKnown;
    conditions_.pop_back();
    return isKnown;
  }

  fs::path root_;
  std::set<std::string> guards_;
  std::vector<Condition> conditions_;
  std::string output_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: froth_bundle_shader FOLDER SOURCE OUTPUT\n");
    return 2;
  }
  try {
    Bundle bundle(argv[1]);
    bundle.add(fs::path(argv[1]) / argv[2]);
    std::ofstream output(argv[3], std::ios::binary);
    if (!(output << bundle.output())) throw std::runtime_error(std::string(argv[3]) + ": cannot be written");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
