// Makes one file of a shader and all that it includes, for engines: every name in it that is neither the language's nor
// one of the public structures' fields gets the prefix froth_, so that it clashes with no name and no macro of theirs.
//
//   froth_bundle_shader FOLDER SOURCE OUTPUT   # OUTPUT ends with .slang: in Slang, else in GLSL
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// clang-format off
const std::set<std::string> kKeptWords = {
    "if", "else", "for", "while", "break", "continue", "return", "struct", "const", "in", "out", "inout", "precise", "true",
    "false", "void", "bool", "int", "uint", "float", "vec2", "vec3", "vec4", "uvec2", "uvec3", "uvec4", "ivec3",
    "layout", "set", "binding", "uniform", "buffer", "readonly", "std140", "std430", "buffer_reference", "buffer_reference_align",
    "abs", "atomicAdd", "bitCount", "clamp", "cos", "dot", "exp", "exp2", "floatBitsToUint", "floor", "max", "min", "normalize", "pow", "sin",
    "sqrt", "tan", "uintBitsToFloat",
    "x", "y", "z", "w", "xy", "yz", "xyz", "rgb", "r", "g", "b", "a",
    // within #if defined(FROTH_SLANG)
    "static", "vk", "ConstantBuffer", "RWStructuredBuffer", "InterlockedAdd", "__ref",
    // of translateBuffers
    "typedef", "__subscript", "get", "loadAligned"};
// What Slang calls GLSL's words. Constants outside of functions are the only ones.
const std::map<std::string, std::string> kSlangWords = {
    {"vec2", "float2"}, {"vec3", "float3"}, {"vec4", "float4"}, {"uvec2", "uint2"}, {"uvec3", "uint3"}, {"uvec4", "uint4"},
    {"ivec3", "int3"}, {"uintBitsToFloat", "asfloat"}, {"floatBitsToUint", "asuint"}, {"bitCount", "countbits"},
    {"atomicAdd", "froth_atomicAdd"}, {"const", "static const"}};
const std::set<std::string> kDirectiveWords = {"define", "undef", "if", "ifdef", "ifndef", "elif", "else", "endif", "defined",
                                               "extension", "require"};
const std::set<std::string> kPublicFields = {"origin", "direction", "tMin", "tMax", "apex", "colours", "mask", "hint", "distance", "normal",
                                             "instance", "chunk", "cell", "userId", "status", "ray", "hit"};
// clang-format on

enum class Language { kGlsl, kSlang };

bool startsWith(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }
bool isWordCharacter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::string translateWord(const std::string& word, bool isDirective, Language language) {
  const auto slang = kSlangWords.find(word);
  if (language == Language::kSlang && slang != kSlangWords.end()) return slang->second;
  const bool isKept = kKeptWords.contains(word) || kPublicFields.contains(word) ||
                      (isDirective && kDirectiveWords.contains(word)) || startsWith(word, "froth") ||
                      startsWith(word, "Froth") || startsWith(word, "FROTH") || startsWith(word, "GL_") ||
                      std::isdigit(static_cast<unsigned char>(word[0]));
  return isKept ? word : "froth_" + word;
}

// A buffer that is reached by its address is a pointer in Slang. Of a vector's address Slang knows only that it is a
// float's, so loads of quads tell.
std::string translateBuffers(const std::string& line) {
  static const std::regex quads(R"(^layout\(buffer_reference.* buffer (\w+) \{ (u?vec4) v\[\]; \};)");
  static const std::regex buffer(R"(^layout\(buffer_reference.* buffer (\w+) \{ (\w+) v(\[\])?; \};)");
  static const std::regex element(R"(\.v\[)");
  const std::string ofQuads = std::regex_replace(
      line, quads,
      "struct $1 { $2* first; __subscript(uint i) -> $2 { get { return loadAligned<16>(first + i); } } };");
  return std::regex_replace(std::regex_replace(ofQuads, buffer, "typedef $2* $1;"), element, "[");
}

// Comments stay.
std::string translateLine(const std::string& original, Language language) {
  const std::string line = language == Language::kSlang ? translateBuffers(original) : original;
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
    result += translateWord(line.substr(i, end - i), isDirective, language);
    i = end;
  }
  return result + line.substr(code);
}

class Bundle {
 public:
  Bundle(fs::path root, Language language) : root_(std::move(root)), language_(language) {}

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
      output_ += translateLine(line, language_) + "\n";
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

  // Conditions that are answered here: those about C++, about whose shader this is, and about its language.
  std::optional<bool> answer(const std::string& line) const {
    const std::pair<const char*, bool> answers[] = {{"defined(__cplusplus)", false},
                                                    {"defined(FROTH_WALK)", true},
                                                    {"defined(FROTH_SLANG)", language_ == Language::kSlang}};
    for (const auto& [condition, isTrue] : answers) {
      if (line == std::string("#if ") + condition) return isTrue;
      if (line == std::string("#if !") + condition) return !isTrue;
    }
    return std::nullopt;
  }

  // Whether a directive is answered here.
  bool decide(const std::string& line) {
    if (startsWith(line, "#if")) {
      const std::optional<bool> isTrue = answer(line);
      conditions_.push_back({isTrue.has_value(), isTrue.value_or(true)});
      return isTrue.has_value();
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
  Language language_;
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
    const bool isSlang = fs::path(argv[3]).extension() == ".slang";
    Bundle bundle(argv[1], isSlang ? Language::kSlang : Language::kGlsl);
    bundle.add(fs::path(argv[1]) / argv[2]);
    std::ofstream output(argv[3], std::ios::binary);
    if (!(output << bundle.output())) throw std::runtime_error(std::string(argv[3]) + ": cannot be written");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
