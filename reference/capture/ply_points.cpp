#include "reference/capture/ply_points.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <type_traits>

#include "foam/checkpoint/little_endian.h"
#include "reference/capture/words.h"

namespace froth {
namespace {

constexpr const char* kPlyRemedy = "write it as nerfstudio does, or leave 'ply_file_path' out";

template <class Number>
double numberAt(const uint8_t* bytes, bool isBigEndian) {
  std::array<uint8_t, sizeof(Number)> copy;
  std::copy_n(bytes, copy.size(), copy.begin());
  if (isBigEndian) std::reverse(copy.begin(), copy.end());
  return static_cast<double>(loadLittleEndian<Number>(copy.data()));
}

struct NumberType {
  const char *name, *otherName;
  size_t size;
  bool isFloat;
  double (*read)(const uint8_t* bytes, bool isBigEndian);
};

template <class Number>
constexpr NumberType typeOf(const char* name, const char* otherName) {
  return {name, otherName, sizeof(Number), std::is_floating_point_v<Number>, numberAt<Number>};
}

constexpr NumberType kTypes[] = {typeOf<int8_t>("char", "int8"),    typeOf<uint8_t>("uchar", "uint8"),
                                 typeOf<int16_t>("short", "int16"), typeOf<uint16_t>("ushort", "uint16"),
                                 typeOf<int32_t>("int", "int32"),   typeOf<uint32_t>("uint", "uint32"),
                                 typeOf<float>("float", "float32"), typeOf<double>("double", "float64")};

// What of a point a number is.
constexpr const char* kPlaceNames[] = {"x", "y", "z"};
constexpr const char* kColourNames[] = {"red", "green", "blue"};
constexpr uint32_t kColours = 3, kNothing = 6;

struct Property {
  NumberType type;
  std::string name;
  uint32_t target = kNothing;  // an axis, or kColours and a channel
  size_t offset = 0;           // in a vertex in binary
};

struct Header {
  bool isText = false, isBigEndian = false;
  uint64_t count = 0;
  std::vector<Property> properties;
  size_t vertexSize = 0;  // in binary

  bool has(uint32_t target) const {
    return std::ranges::any_of(properties, [&](const Property& property) { return property.target == target; });
  }
};

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  while (!(line = trimSpaces(line)).empty()) words.push_back(takeWord(line));
  return words;
}

uint32_t targetOf(std::string_view name) {
  if (name.starts_with("diffuse_")) name.remove_prefix(8);
  for (uint32_t i = 0; i < 3; ++i) {
    if (name == kPlaceNames[i]) return i;
    if (name == kColourNames[i]) return kColours + i;
  }
  return kNothing;
}

class HeaderReader {
 public:
  HeaderReader(const NamedBytes& file, std::string_view text) : file_(file), rest_(text) {}

  // Up to the first byte of the vertices.
  Status read(Header& header) {
    if (takeLine() != "ply") return badInput(file_.name, "found no PLY header; get the file again");
    while (!isAtEnd_) {
      const std::vector<std::string_view> words = wordsOf(takeLine());
      if (words.empty()) continue;
      if (words[0] == "end_header") return check(header);
      if (Status taken = take(words, header); !taken) return taken;
    }
    return badInput(file_.name, "the header does not end; get the file again");
  }

  std::string_view rest() const { return rest_; }

 private:
  std::string_view takeLine() {
    const size_t end = rest_.find('\n');
    isAtEnd_ = end == std::string_view::npos;
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(isAtEnd_ ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  Status take(const std::vector<std::string_view>& words, Header& header) {
    if (words[0] == "format" && words.size() == 3) return takeFormat(words[1], header);
    if (words[0] == "element" && words.size() == 3) return takeElement(words[1], words[2], header);
    if (words[0] == "property" && words.size() >= 3) {
      return elements_ == 1 ? takeProperty(words, header) : Status();  // others stand behind the vertices
    }
    return {};  // comments, and what some programs write without that word
  }

  Status takeFormat(std::string_view format, Header& header) {
    header.isText = format == "ascii";
    header.isBigEndian = format == "binary_big_endian";
    hasFormat_ = header.isText || header.isBigEndian || format == "binary_little_endian";
    return hasFormat_ ? Status()
                      : badInput(file_.name, "header: found format {}; {}", froth::quoted(format), kPlyRemedy);
  }

  Status takeElement(std::string_view name, std::string_view count, Header& header) {
    if (++elements_ > 1) return {};
    const auto [end, code] = std::from_chars(count.data(), count.data() + count.size(), header.count);
    const bool isCount = code == std::errc{} && end == count.data() + count.size();
    if (name == "vertex" && isCount) return {};
    return badInput(file_.name, "header: found element {} {}; put the vertices first", froth::quoted(name),
                    froth::quoted(count));
  }

  Status takeProperty(const std::vector<std::string_view>& words, Header& header) {
    const auto type = std::ranges::find_if(
        kTypes, [&](const NumberType& each) { return words[1] == each.name || words[1] == each.otherName; });
    if (type == std::end(kTypes)) {
      return badInput(file_.name, "header: found a vertex with a property of type {}; give numbers",
                      froth::quoted(words[1]));
    }
    const uint32_t target = targetOf(words[2]);
    if (target != kNothing && header.has(target)) {
      return badInput(file_.name, "header: found {} twice; {}", froth::quoted(words[2]), kPlyRemedy);
    }
    header.properties.push_back({*type, std::string(words[2]), target, header.vertexSize});
    header.vertexSize += type->size;
    return {};
  }

  // Whether there are places, and as many vertices as the bytes can hold.
  Status check(const Header& header) const {
    if (!hasFormat_) return badInput(file_.name, "header: found no format; {}", kPlyRemedy);
    for (uint32_t axis = 0; axis < 3; ++axis) {
      if (header.has(axis)) continue;
      return badInput(file_.name, "header: found no '{}' of vertices; {}", kPlaceNames[axis], kPlyRemedy);
    }
    // A number in text has a digit and a space behind it, but for the last.
    const uint64_t least = header.isText ? 2 * header.properties.size() : header.vertexSize;
    const uint64_t most = (rest_.size() + (header.isText ? 1 : 0)) / least;
    if (header.count <= most) return {};
    return badInput(file_.name,
                    "header: found {} vertices, which take at least {} bytes each; the file has {} bytes left; get the "
                    "whole file again",
                    header.count, least, rest_.size());
  }

  const NamedBytes& file_;
  std::string_view rest_;
  bool isAtEnd_ = false, hasFormat_ = false;
  uint32_t elements_ = 0;
};

// The next number in text, which need not begin a line.
std::optional<double> takeNumber(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  double number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (code != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return number;
}

void setNumber(const Property& property, double number, CapturedPoint& point) {
  if (property.target < kColours) {
    point.position[static_cast<int>(property.target)] = number;
  } else if (property.target < kNothing) {
    const double byte = property.type.isFloat ? 255 * number : number;
    point.colour[property.target - kColours] = static_cast<uint8_t>(std::lround(std::clamp(byte, 0.0, 255.0)));
  }
}

}  // namespace

Result<std::vector<CapturedPoint>> parsePlyPoints(const NamedBytes& file) {
  const std::string_view text(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size());
  HeaderReader reader(file, text);
  Header header;
  if (Status read = reader.read(header); !read) return read.error();
  std::string_view rest = reader.rest();
  const uint8_t* vertex = file.bytes.data() + (text.size() - rest.size());  // in binary
  std::vector<CapturedPoint> points(header.count);
  for (uint64_t i = 0; i < header.count; ++i, vertex += header.vertexSize) {
    points[i].colour = {128, 128, 128};
    for (const Property& property : header.properties) {
      const std::optional<double> number =
          header.isText ? takeNumber(rest) : property.type.read(vertex + property.offset, header.isBigEndian);
      if (!number || (property.target != kNothing && !std::isfinite(*number))) {
        return badInput(file.name, "vertex {}, field {}: found {}; {}", i, froth::quoted(property.name),
                        number ? "a number that is not finite" : "no number", kPlyRemedy);
      }
      setNumber(property, *number, points[i]);
    }
  }
  return points;
}

}  // namespace froth
