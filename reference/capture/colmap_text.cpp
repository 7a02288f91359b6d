// cameras.txt, images.txt and points3D.txt: a record per line, two lines for an image; lines with # are comments.
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "reference/capture/colmap_records.h"
#include "reference/capture/words.h"

namespace froth {
namespace {

// Lines of a file, and the words of the line it stands at. The first fault is kept; what follows it reads zeros.
class TextReader {
 public:
  explicit TextReader(const NamedBytes& file)
      : file_(file), rest_(reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()) {}

  // Goes to the next line, whatever it holds; false at the end.
  bool nextLine() {
    if (rest_.empty()) return false;
    const size_t end = rest_.find('\n');
    line_ = trimSpaces(rest_.substr(0, end));
    rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
    ++number_;
    return true;
  }

  // Goes to the next line that is neither empty nor a comment; false at the end and after a fault.
  bool nextRecord() {
    while (!error_ && nextLine()) {
      if (!line_.empty() && line_[0] != '#') return true;
    }
    return false;
  }

  bool hasWord() const { return !line_.empty(); }

  std::string_view takeWord(const char* field) {
    if (line_.empty()) {
      fail(fmt::format("field '{}': found the end of the line", field));
      return {};
    }
    return froth::takeWord(line_);
  }

  template <class Number>
  Number take(const char* field) {
    const std::string_view word = takeWord(field);
    Number number{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (code == std::errc{} && end == word.data() + word.size()) return number;
    fail(fmt::format("field '{}': found {}", field, froth::quoted(word)));
    return {};
  }

  glm::dvec3 takeVector(const char* field) {
    glm::dvec3 vector;
    for (int axis = 0; axis < 3; ++axis) vector[axis] = take<double>(field);
    return vector;
  }

  // Names may hold spaces.
  std::string takeRest(const char* field) {
    if (line_.empty()) takeWord(field);
    return std::string(std::exchange(line_, {}));
  }

  void fail(const std::string& what) {
    if (error_) return;
    error_ = badInput(file_.name, "line {}: {}; write it as COLMAP does, or export it again", number_, what);
  }

  const std::optional<Error>& error() const { return error_; }

 private:
  const NamedBytes& file_;
  std::string_view rest_, line_;
  size_t number_ = 0;
  std::optional<Error> error_;
};

template <class Record, class Read>
Result<std::vector<Record>> readTextRecords(const NamedBytes& file, const Read& readRecord) {
  TextReader reader(file);
  std::vector<Record> records;
  while (reader.nextRecord()) records.push_back(readRecord(reader));
  if (reader.error()) return *reader.error();
  return records;
}

ColmapCamera readTextCamera(TextReader& reader) {
  ColmapCamera camera;
  camera.id = reader.take<uint32_t>("CAMERA_ID");
  camera.model = reader.takeWord("MODEL");
  camera.width = reader.take<uint64_t>("WIDTH");
  camera.height = reader.take<uint64_t>("HEIGHT");
  while (reader.hasWord() && !reader.error()) camera.parameters.push_back(reader.take<double>("PARAMS"));
  return camera;
}

ColmapImage readTextImage(TextReader& reader) {
  ColmapImage image;
  image.id = reader.take<uint32_t>("IMAGE_ID");
  for (double& component : image.rotation) component = reader.take<double>("QW, QX, QY, QZ");
  image.translation = reader.takeVector("TX, TY, TZ");
  image.camera = reader.take<uint32_t>("CAMERA_ID");
  image.name = reader.takeRest("NAME");
  reader.nextLine();  // its observations, which may be none: an empty line
  return image;
}

ColmapPoint readTextPoint(TextReader& reader) {
  ColmapPoint point;
  point.id = reader.take<uint64_t>("POINT3D_ID");
  point.position = reader.takeVector("X, Y, Z");
  for (uint8_t& channel : point.colour) channel = reader.take<uint8_t>("R, G, B");
  reader.take<double>("ERROR");
  while (reader.hasWord() && !reader.error()) {
    point.track.push_back(reader.take<uint32_t>("TRACK"));
    reader.take<uint32_t>("TRACK");
  }
  return point;
}

}  // namespace

Result<std::vector<ColmapCamera>> readTextCameras(const NamedBytes& file) {
  return readTextRecords<ColmapCamera>(file, readTextCamera);
}

Result<std::vector<ColmapImage>> readTextImages(const NamedBytes& file) {
  return readTextRecords<ColmapImage>(file, readTextImage);
}

Result<std::vector<ColmapPoint>> readTextPoints(const NamedBytes& file) {
  return readTextRecords<ColmapPoint>(file, readTextPoint);
}

}  // namespace froth
