#include "measure/stability/case_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/bake/check_foam.h"
#include "base/atomic_file.h"
#include "base/json_input.h"

namespace froth {
namespace {

using ReadJson = nlohmann::json;

constexpr uint32_t kMostChunkCells = 1 << 20;  // as `froth bake` takes

// Values of one JSON object. The first fault is kept; later reads then return zeros.
class FieldReader {
 public:
  FieldReader(const ReadJson& object, std::string place, std::optional<Error>& error)
      : object_(object), place_(std::move(place)), error_(error) {
    if (!object.is_object()) fail("", std::string("found ") + object.type_name() + "; give an object");
  }

  const ReadJson* find(const char* key) const {
    if (error_ || !object_.is_object()) return nullptr;
    const auto it = object_.find(key);
    return it == object_.end() ? nullptr : &*it;
  }

  std::string readText(const char* key) {
    const ReadJson* value = require(key);
    if (!value) return {};
    if (value->is_string()) return value->get<std::string>();
    fail(key, std::string("found ") + value->type_name() + "; give a text in quotes");
    return {};
  }

  bool readFlag(const char* key) {
    const ReadJson* value = require(key);
    if (!value) return false;
    if (value->is_boolean()) return value->get<bool>();
    fail(key, std::string("found ") + value->type_name() + "; give true or false");
    return false;
  }

  uint32_t readCount(const char* key, uint32_t most) {
    const ReadJson* value = require(key);
    if (!value) return 0;
    if (value->is_number_unsigned() && value->get<uint64_t>() <= most) return value->get<uint32_t>();
    fail(key, "give a whole number up to " + std::to_string(most));
    return 0;
  }

  template <class Number>
  Number readNumber(const char* key) {
    const ReadJson* value = require(key);
    return value ? asNumber<Number>(key, *value) : Number(0);
  }

  template <class Vector>
  Vector readVector(const char* key) {
    const ReadJson* value = require(key);
    return value ? asVector<Vector>(key, *value, 0, Vector::length()) : Vector(0);
  }

  // Numbers [first, first + length of Vector) of an array of `size`.
  template <class Vector>
  Vector asVector(const char* key, const ReadJson& array, size_t first, size_t size) {
    Vector vector(0);
    if (!array.is_array() || array.size() != size) {
      fail(key, "give " + std::to_string(size) + " numbers");
      return vector;
    }
    for (int axis = 0; axis < Vector::length(); ++axis) {
      vector[axis] = asNumber<typename Vector::value_type>(key, array[first + static_cast<size_t>(axis)]);
    }
    return vector;
  }

  // Never null: an empty one after a fault.
  const ReadJson& readArray(const char* key) {
    static const ReadJson kEmpty = ReadJson::array();
    const ReadJson* value = require(key);
    if (!value) return kEmpty;
    if (value->is_array()) return *value;
    fail(key, std::string("found ") + value->type_name() + "; give an array");
    return kEmpty;
  }

  // The same, for a field that may be absent.
  const ReadJson& readOptionalArray(const char* key) {
    static const ReadJson kEmpty = ReadJson::array();
    return find(key) ? readArray(key) : kEmpty;
  }

  bool hasFailed() const { return error_.has_value(); }

  void fail(const char* key, const std::string& fault) {
    if (error_) return;
    error_ = makeError(ErrorKind::kBadInput, "%s, field '%s': %s", place_.c_str(), key, fault.c_str());
  }

 private:
  const ReadJson* require(const char* key) {
    const ReadJson* value = find(key);
    if (!value) fail(key, "found nothing; add it (measure/stability/case_file.h lists the fields)");
    return value;
  }

  template <class Number>
  Number asNumber(const char* key, const ReadJson& value) {
    const auto number = value.is_number() ? static_cast<Number>(value.get<double>()) : Number(NAN);
    if (std::isfinite(number)) return number;
    fail(key, "give finite numbers");
    return 0;
  }

  const ReadJson& object_;
  const std::string place_;
  std::optional<Error>& error_;
};

// Appends what one detail site holds; how many lobes it has is left to lobeOffsets.
void readDetail(FieldReader fields, Foam& foam) {
  foam.detailSites.push_back(fields.readVector<glm::vec2>("place"));
  foam.detailHeights.push_back(fields.readNumber<float>("height"));
  if (fields.find("base")) foam.baseColours.push_back(fields.readVector<glm::vec3>("base"));
  const ReadJson& lobes = fields.readArray("lobes");
  for (const ReadJson& lobe : lobes) {
    foam.lobeAxes.push_back(fields.asVector<glm::vec3>("lobes", lobe, 0, 6));
    foam.lobeColours.push_back(fields.asVector<glm::vec3>("lobes", lobe, 3, 6));
  }
  if (lobes.size() > foam.lobeCount) fields.fail("lobes", "more than 'most_lobes'; raise that, to 32 at most");
  foam.lobeOffsets.push_back(foam.lobeAxes.size());
}

void readCell(const ReadJson& cell, const std::string& place, std::optional<Error>& error, Foam& foam) {
  FieldReader fields(cell, place, error);
  foam.sites.push_back(fields.readVector<glm::vec3>("site"));
  foam.radii.push_back(fields.readNumber<float>("radius"));
  foam.densities.push_back(fields.readNumber<float>("density"));
  foam.orientations.push_back(fields.readVector<glm::vec4>("orientation"));
  const ReadJson& details = fields.readArray("details");
  if (foam.cellCount++ == 0) foam.detailCount = static_cast<uint32_t>(std::min<size_t>(details.size(), UINT32_MAX));
  if (details.size() != foam.detailCount) fields.fail("details", "give as many in every cell");
  for (size_t k = 0; k < details.size() && !error; ++k) {
    readDetail(FieldReader(details[k], place + ", detail site " + std::to_string(k), error), foam);
  }
}

void readKnown(FieldReader& root, const std::string& file, std::optional<Error>& error,
               std::vector<KnownFault>& known) {
  const ReadJson& faults = root.readArray("known");
  for (size_t i = 0; i < faults.size() && !error; ++i) {
    FieldReader fields(faults[i], file + ": known fault " + std::to_string(i), error);
    KnownFault fault{fields.readText("preset"), fields.readText("renderer"), fields.readText("kind"), 0, {}};
    fault.factor = fields.readNumber<double>("factor");
    fault.cause = fields.readText("cause");
    known.push_back(std::move(fault));
  }
}

// As the runtime asks of an instance (frothCreateInstance).
constexpr double kUnitTolerance = 1e-3;  // of a quaternion's squared length

CasePlace readPlace(FieldReader fields) {
  CasePlace place;
  place.position = fields.readVector<glm::dvec3>("position");
  const auto turn = fields.readVector<glm::vec4>("rotation");
  const double squared = glm::dot(glm::dvec4(turn), glm::dvec4(turn));
  if (!(std::abs(squared - 1) <= kUnitTolerance)) {
    fields.fail("rotation", "a quaternion of squared length " + std::to_string(squared) + "; normalize it");
  }
  place.rotation = glm::quat(turn.x, turn.y, turn.z, turn.w);  // w first
  place.scale = fields.readNumber<float>("scale");
  if (!(place.scale > 0)) fields.fail("scale", "found " + std::to_string(place.scale) + "; give a number above 0");
  return place;
}

// Whatever is not the foam and its views; absent: the default.
void readParts(FieldReader& root, const std::string& file, std::optional<Error>& error, StiffCase& found) {
  const ReadJson& places = root.readOptionalArray("places");
  if (places.size() > kMostPlaces) {
    root.fail("places", "found " + std::to_string(places.size()) + "; give at most " + std::to_string(kMostPlaces));
  }
  for (size_t i = 0; i < places.size() && !error; ++i) {
    found.places.push_back(readPlace(FieldReader(places[i], file + ": place " + std::to_string(i), error)));
  }
  if (root.find("jitter")) found.jitter = root.readVector<glm::vec2>("jitter");
  if (root.find("chunk_cells")) found.chunkCells = root.readCount("chunk_cells", kMostChunkCells);
  if (root.find("layers")) found.layers = root.readCount("layers", kAllLayersOfCase);
  if (found.layers == 0) root.fail("layers", "found 0; give at least 1");
}

Image readEnds(FieldReader& root, const ReadJson& rows, size_t index, const View& view) {
  const std::string place = "view " + std::to_string(index);
  Image image{view.width, view.height, 1, {}};
  if (!rows.is_array() || rows.size() != view.height) {
    root.fail("ends", place + ": give " + std::to_string(view.height) + " rows");
  }
  for (size_t y = 0; y < rows.size() && !root.hasFailed(); ++y) {
    const std::string where = place + ", row " + std::to_string(y);
    if (!rows[y].is_array() || rows[y].size() != view.width) {
      root.fail("ends", where + ": give " + std::to_string(view.width) + " numbers");
    }
    for (const ReadJson& end : rows[y]) {
      const bool isNever = end.is_string() && end.get_ref<const std::string&>() == kNeverInCaseFile;
      const float value = end.is_number() ? static_cast<float>(end.get<double>()) : NAN;
      if (!isNever && !std::isfinite(value)) root.fail("ends", where + ": give finite numbers, or \"never\"");
      image.values.push_back(isNever ? std::numeric_limits<float>::infinity() : value);
    }
  }
  return image;
}

void readAllEnds(FieldReader& root, StiffCase& found) {
  const ReadJson& images = root.readOptionalArray("ends");
  if (!images.empty() && images.size() != found.views.size()) {
    root.fail("ends", "found " + std::to_string(images.size()) + " images; give one for each of the " +
                          std::to_string(found.views.size()) + " views");
  }
  for (size_t i = 0; i < images.size() && !root.hasFailed(); ++i) {
    found.ends.push_back(readEnds(root, images[i], i, found.views[i]));
  }
}

void readFoam(FieldReader& root, const std::string& file, std::optional<Error>& error, Foam& foam) {
  foam.lobeCount = root.readCount("most_lobes", 32);
  foam.lobeOffsets = {0};
  const ReadJson& cells = root.readArray("cells");
  for (size_t i = 0; i < cells.size() && !error; ++i) {
    readCell(cells[i], file + ": cell " + std::to_string(i), error, foam);
  }
  const bool isUniform = foam.lobeAxes.size() == foam.detailSites.size() * foam.lobeCount;
  if (isUniform) foam.lobeOffsets.clear();
  if (!foam.baseColours.empty() && foam.baseColours.size() != foam.detailSites.size()) {
    root.fail("cells", "give every detail site a 'base', or none");
  }
}

}  // namespace

Result<StiffCase> parseCase(std::span<const uint8_t> bytes, const std::string& file) {
  const Result<ReadJson> json = parseJson(bytes, file, "write the stiff case again");
  if (!json) return json.error();
  std::optional<Error> error;
  FieldReader root(*json, file, error);
  StiffCase found;
  found.name = root.readText("name");
  found.what = root.readText("what");
  found.analysis = root.readText("analysis");
  found.moved = root.readVector<glm::dvec3>("moved");
  found.isImported = root.readFlag("imported");
  readKnown(root, file, error, found.known);
  readParts(root, file, error, found);
  readFoam(root, file, error, found.foam);
  if (error) return *error;
  if (const Status status = checkFoam(found.foam); !status) {
    return makeError(ErrorKind::kBadInput, "%s: %s", file.c_str(), status.error().message.c_str());
  }
  Result<CameraSet> cameras = parseCameras(bytes, file);
  if (!cameras) return cameras.error();
  found.views = std::move(cameras->views);
  readAllEnds(root, found);
  if (error) return *error;
  return found;
}

Result<StiffCase> readCase(const std::filesystem::path& path) {
  const Result<std::vector<uint8_t>> bytes = readFile(path, kMostJsonBytes);
  if (!bytes) return bytes.error();
  return parseCase(*bytes, path.string());
}

}  // namespace froth
