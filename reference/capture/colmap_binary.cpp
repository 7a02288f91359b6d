// cameras.bin, images.bin and points3D.bin: little-endian, each a count and so many records.
#include <algorithm>
#include <iterator>
#include <optional>

#include "foam/checkpoint/little_endian.h"
#include "reference/capture/colmap_records.h"

namespace froth {
namespace {

// The least that a record of each file takes [bytes].
constexpr uint64_t kCameraBytes = 48, kImageBytes = 73, kPointBytes = 51;
constexpr uint64_t kObservationBytes = 24;  // x, y, point: of an image; not read
constexpr uint64_t kTrackBytes = 8;         // image, observation

// Takes numbers from front to back. The first fault is kept; what follows it reads zeros.
class BinaryReader {
 public:
  explicit BinaryReader(const NamedBytes& file) : file_(file) {}

  // Fields are of this record from now on.
  void enter(const char* kind, uint64_t index) {
    kind_ = kind;
    index_ = index;
  }

  template <class Number>
  Number take(const char* field) {
    const uint8_t* bytes = skip(field, sizeof(Number));
    return bytes ? loadLittleEndian<Number>(bytes) : Number{};
  }

  glm::dvec3 takeVector(const char* field) {
    glm::dvec3 vector;
    for (int axis = 0; axis < 3; ++axis) vector[axis] = take<double>(field);
    return vector;
  }

  // Of records or elements that take at least `leastBytes` each.
  uint64_t takeCount(const char* field, uint64_t leastBytes) {
    const auto count = take<uint64_t>(field);
    if (error_ || count <= left() / leastBytes) return count;
    fail(fmt::format("field '{}': found {}, which take at least {} bytes each; the file has {} bytes left", field,
                     count, leastBytes, left()));
    return 0;
  }

  // Up to a NUL, which is taken too.
  std::string takeText(const char* field) {
    const auto rest = file_.bytes.subspan(cursor_);
    const auto end = std::find(rest.begin(), rest.end(), uint8_t{0});
    if (error_ || end == rest.end()) {
      fail(fmt::format("field '{}': found no end of the text", field));
      return {};
    }
    cursor_ += static_cast<size_t>(end - rest.begin()) + 1;
    return {rest.begin(), end};
  }

  // Null: the file ends before that.
  const uint8_t* skip(const char* field, uint64_t count) {
    if (error_) return nullptr;
    if (count > left()) {
      fail(fmt::format("field '{}': needs {} bytes, the file has {} left", field, count, left()));
      return nullptr;
    }
    const uint8_t* bytes = file_.bytes.data() + cursor_;
    cursor_ += count;
    return bytes;
  }

  void refuseRest() {
    if (!error_ && left() > 0) fail(fmt::format("is the last, but {} bytes follow it", left()));
  }

  // Keeps the first fault.
  void fail(const std::string& what, const char* remedy = "copy the whole file again") {
    if (error_) return;
    const std::string record = kind_ ? fmt::format("{} {}", kind_, index_) : std::string("header");
    error_ = badInput(file_.name, "{}: {}; {}", record, what, remedy);
  }

  bool failed() const { return error_.has_value(); }
  const Error& error() const { return *error_; }

 private:
  uint64_t left() const { return file_.bytes.size() - cursor_; }

  const NamedBytes& file_;
  size_t cursor_ = 0;
  const char* kind_ = nullptr;
  uint64_t index_ = 0;
  std::optional<Error> error_;
};

// Each file: a count, and so many records, which `readRecord` reads.
template <class Record, class Read>
Result<std::vector<Record>> readRecords(const NamedBytes& file, const char* kind, uint64_t leastBytes,
                                        const Read& readRecord) {
  BinaryReader reader(file);
  const uint64_t count = reader.takeCount("count", leastBytes);
  std::vector<Record> records;
  records.reserve(count);
  for (uint64_t i = 0; i < count && !reader.failed(); ++i) {
    reader.enter(kind, i);
    records.push_back(readRecord(reader));
  }
  reader.refuseRest();
  if (reader.failed()) return reader.error();
  return records;
}

ColmapCamera readCamera(BinaryReader& reader) {
  ColmapCamera camera;
  camera.id = reader.take<uint32_t>("id");
  const auto model = static_cast<uint32_t>(reader.take<int32_t>("model"));
  camera.width = reader.take<uint64_t>("width");
  camera.height = reader.take<uint64_t>("height");
  if (model >= std::size(kColmapModels)) {
    reader.fail(fmt::format("field 'model': found {}", static_cast<int32_t>(model)),
                "calibrate with one of COLMAP's models 0 to 10, such as OPENCV");
    return camera;
  }
  camera.model = kColmapModels[model].name;
  for (uint32_t i = 0; i < kColmapModels[model].parameterCount; ++i) {
    camera.parameters.push_back(reader.take<double>("params"));
  }
  return camera;
}

ColmapImage readImageRecord(BinaryReader& reader) {
  ColmapImage image;
  image.id = reader.take<uint32_t>("id");
  for (double& component : image.rotation) component = reader.take<double>("qvec");
  image.translation = reader.takeVector("tvec");
  image.camera = reader.take<uint32_t>("camera_id");
  image.name = reader.takeText("name");
  const uint64_t observations = reader.takeCount("num_points2D", kObservationBytes);
  reader.skip("points2D", observations * kObservationBytes);
  return image;
}

ColmapPoint readPoint(BinaryReader& reader) {
  ColmapPoint point;
  point.id = reader.take<uint64_t>("id");
  point.position = reader.takeVector("xyz");
  for (uint8_t& channel : point.colour) channel = reader.take<uint8_t>("rgb");
  reader.take<double>("error");
  const uint64_t length = reader.takeCount("track length", kTrackBytes);
  point.track.reserve(length);
  for (uint64_t i = 0; i < length; ++i) {
    point.track.push_back(reader.take<uint32_t>("track"));
    reader.take<uint32_t>("track");
  }
  return point;
}

}  // namespace

Result<std::vector<ColmapCamera>> readBinaryCameras(const NamedBytes& file) {
  return readRecords<ColmapCamera>(file, "camera", kCameraBytes, readCamera);
}

Result<std::vector<ColmapImage>> readBinaryImages(const NamedBytes& file) {
  return readRecords<ColmapImage>(file, "image", kImageBytes, readImageRecord);
}

Result<std::vector<ColmapPoint>> readBinaryPoints(const NamedBytes& file) {
  return readRecords<ColmapPoint>(file, "point", kPointBytes, readPoint);
}

}  // namespace froth
