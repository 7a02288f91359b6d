#include "measure/stability/case_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "baker/bake/check_foam.h"
#include "base/atomic_file.h"
#include "base/json_input.h"

namespace froth {
namespace {

using Json = nlohmann::json;
using WrittenJson = nlohmann::ordered_json;

// ---- Writing

// The double that prints with the few digits of a float, if those give the float back.
double shortest(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double decimal = 0;
  std::from_chars(text, end, decimal);
  return static_cast<float>(decimal) == value ? decimal : double{value};
}

template <class Vector>
WrittenJson toJson(const Vector& vector) {
  WrittenJson array = WrittenJson::array();
  for (int axis = 0; axis < Vector::length(); ++axis) {
    if constexpr (std::is_same_v<typename Vector::value_type, float>) {
      array.push_back(shortest(vector[axis]));
    } else {
      array.push_back(vector[axis]);
    }
  }
  return array;
}

WrittenJson detailToJson(const Foam& foam, size_t site) {
  WrittenJson detail = {{"place", toJson(foam.detailSites[site])}, {"height", shortest(foam.detailHeights[site])}};
  if (!foam.baseColours.empty()) detail["base"] = toJson(foam.baseColours[site]);
  WrittenJson lobes = WrittenJson::array();
  const LobeRange range = lobesOf(foam, site);
  for (uint64_t m = range.first; m < range.first + range.count; ++m) {
    WrittenJson lobe = toJson(foam.lobeAxes[m]);
    for (int channel = 0; channel < 3; ++channel) lobe.push_back(shortest(foam.lobeColours[m][channel]));
    lobes.push_back(std::move(lobe));
  }
  detail["lobes"] = std::move(lobes);
  return detail;
}

WrittenJson knownToJson(const std::vector<KnownFault>& known) {
  WrittenJson list = WrittenJson::array();
  for (const KnownFault& fault : known) {
    list.push_back({{"preset", fault.preset},
                    {"renderer", fault.renderer},
                    {"kind", fault.kind},
                    {"factor", fault.factor},
                    {"cause", fault.cause}});
  }
  return list;
}

WrittenJson cellToJson(const Foam& foam, uint32_t cell) {
  WrittenJson details = WrittenJson::array();
  for (uint32_t k = 0; k < foam.detailCount; ++k) details.push_back(detailToJson(foam, size_t{cell} * foam.detailCount + k));
  return {{"site", toJson(foam.sites[cell])},
          {"radius", shortest(foam.radii[cell])},
          {"density", shortest(foam.densities[cell])},
          {"orientation", toJson(foam.orientations[cell])},
          {"details", std::move(details)}};
}

// A detail site or a row of numbers on one line, everything else indented.
void print(const WrittenJson& value, size_t depth, std::string& text) {
  constexpr size_t kDetailDepth = 4;
  const bool isRow = value.is_array() && (value.empty() || value.front().is_number());
  if (!value.is_structured() || isRow || depth >= kDetailDepth) {
    text += value.dump(-1, ' ', false, WrittenJson::error_handler_t::replace);
    return;
  }
  text += value.is_object() ? '{' : '[';
  const char* separator = "\n";
  for (const auto& [key, child] : value.items()) {
    text += separator + std::string(depth + 1, ' ');
    separator = ",\n";
    if (value.is_object()) text += '"' + key + "\": ";
    print(child, depth + 1, text);
  }
  text += '\n' + std::string(depth, ' ') + (value.is_object() ? '}' : ']');
}

// ---- Reading

// Values of one JSON object. The first fault is kept; later reads then return zeros.
class FieldReader {
 public:
  FieldReader(const Json& object, std::string place, std::optional<Error>& error)
      : object_(object), place_(std::move(place)), error_(error) {
    if (!object.is_object()) fail("", std::string("found ") + object.type_name() + "; give an object");
  }

  const Json* find(const char* key) const {
    if (error_ || !object_.is_object()) return nullptr;
    const auto it = object_.find(key);
    return it == object_.end() ? nullptr : &*it;
  }

  std::string readText(const char* key) {
    const Json* value = require(key);
    if (!value) return {};
    if (value->is_string()) return value->get<std::string>();
    fail(key, std::string("found ") + value->type_name() + "; give a text in quotes");
    return {};
  }

  bool readFlag(const char* key) {
    const Json* value = require(key);
    if (!value) return false;
    if (value->is_boolean()) return value->get<bool>();
    fail(key, std::string("found ") + value->type_name() + "; give true or false");
    return false;
  }

  uint32_t readCount(const char* key, uint32_t most) {
    const Json* value = require(key);
    if (!value) return 0;
    if (value->is_number_unsigned() && value->get<uint64_t>() <= most) return value->get<uint32_t>();
    fail(key, "give a whole number up to " + std::to_string(most));
    return 0;
  }

  template <class Number>
  Number readNumber(const char* key) {
    const Json* value = require(key);
    return value ? asNumber<Number>(key, *value) : Number(0);
  }

  template <class Vector>
  Vector readVector(const char* key) {
    const Json* value = require(key);
    return value ? asVector<Vector>(key, *value, 0, Vector::length()) : Vector(0);
  }

  // Numbers [first, first + length of Vector) of an array of `size`.
  template <class Vector>
  Vector asVector(const char* key, const Json& array, size_t first, size_t size) {
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
  const Json& readArray(const char* key) {
    static const Json kEmpty = Json::array();
    const Json* value = require(key);
    if (!value) return kEmpty;
    if (value->is_array()) return *value;
    fail(key, std::string("found ") + value->type_name() + "; give an array");
    return kEmpty;
  }

  void fail(const char* key, const std::string& fault) {
    if (error_) return;
    error_ = makeError(ErrorKind::kBadInput, "%s, field '%s': %s", place_.c_str(), key, fault.c_str());
  }

 private:
  const Json* require(const char* key) {
    const Json* value = find(key);
    if (!value) fail(key, "found nothing; add it (measure/stability/case_file.h lists the fields)");
    return value;
  }

  template <class Number>
  Number asNumber(const char* key, const Json& value) {
    const auto number = value.is_number() ? static_cast<Number>(value.get<double>()) : Number(NAN);
    if (std::isfinite(number)) return number;
    fail(key, "give finite numbers");
    return 0;
  }

  const Json& object_;
  const std::string place_;
  std::optional<Error>& error_;
};

// Appends what one detail site holds; how many lobes it has is left to lobeOffsets.
void readDetail(FieldReader fields, Foam& foam) {
  foam.detailSites.push_back(fields.readVector<glm::vec2>("place"));
  foam.detailHeights.push_back(fields.readNumber<float>("height"));
  if (fields.find("base")) foam.baseColours.push_back(fields.readVector<glm::vec3>("base"));
  const Json& lobes = fields.readArray("lobes");
  for (const Json& lobe : lobes) {
    foam.lobeAxes.push_back(fields.asVector<glm::vec3>("lobes", lobe, 0, 6));
    foam.lobeColours.push_back(fields.asVector<glm::vec3>("lobes", lobe, 3, 6));
  }
  if (lobes.size() > foam.lobeCount) fields.fail("lobes", "more than 'most_lobes'; raise that, to 32 at most");
  foam.lobeOffsets.push_back(foam.lobeAxes.size());
}

void readCell(const Json& cell, const std::string& place, std::optional<Error>& error, Foam& foam) {
  FieldReader fields(cell, place, error);
  foam.sites.push_back(fields.readVector<glm::vec3>("site"));
  foam.radii.push_back(fields.readNumber<float>("radius"));
  foam.densities.push_back(fields.readNumber<float>("density"));
  foam.orientations.push_back(fields.readVector<glm::vec4>("orientation"));
  const Json& details = fields.readArray("details");
  if (foam.cellCount++ == 0) foam.detailCount = static_cast<uint32_t>(std::min<size_t>(details.size(), UINT32_MAX));
  if (details.size() != foam.detailCount) fields.fail("details", "give as many in every cell");
  for (size_t k = 0; k < details.size() && !error; ++k) {
    readDetail(FieldReader(details[k], place + ", detail site " + std::to_string(k), error), foam);
  }
}

void readKnown(FieldReader& root, const std::string& file, std::optional<Error>& error, std::vector<KnownFault>& known) {
  const Json& faults = root.readArray("known");
  for (size_t i = 0; i < faults.size() && !error; ++i) {
    FieldReader fields(faults[i], file + ": known fault " + std::to_string(i), error);
    KnownFault fault{fields.readText("preset"), fields.readText("renderer"), fields.readText("kind"), 0, {}};
    fault.factor = fields.readNumber<double>("factor");
    fault.cause = fields.readText("cause");
    known.push_back(std::move(fault));
  }
}

void readFoam(FieldReader& root, const std::string& file, std::optional<Error>& error, Foam& foam) {
  foam.lobeCount = root.readCount("most_lobes", 32);
  foam.lobeOffsets = {0};
  const Json& cells = root.readArray("cells");
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
  const Result<Json> json = parseJson(bytes, file, "write the stiff case again");
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
  readFoam(root, file, error, found.foam);
  if (error) return *error;
  if (const Status status = checkFoam(found.foam); !status) {
    return makeError(ErrorKind::kBadInput, "%s: %s", file.c_str(), status.error().message.c_str());
  }
  Result<CameraSet> cameras = parseCameras(bytes, file);
  if (!cameras) return cameras.error();
  found.views = std::move(cameras->views);
  return found;
}

Result<StiffCase> readCase(const std::filesystem::path& path) {
  const Result<std::vector<uint8_t>> bytes = readFile(path, kMostJsonBytes);
  if (!bytes) return bytes.error();
  return parseCase(*bytes, path.string());
}

Status writeCase(const std::filesystem::path& path, const StiffCase& stiffCase) {
  if (const Status status = checkFoam(stiffCase.foam); !status) return status;
  CameraSet cameras;
  cameras.views = stiffCase.views;
  const Result<std::string> views = camerasText(cameras, path.string());
  if (!views) return views.error();

  const Foam& foam = stiffCase.foam;
  WrittenJson cells = WrittenJson::array();
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) cells.push_back(cellToJson(foam, cell));
  const WrittenJson root = {{"name", stiffCase.name},
                            {"what", stiffCase.what},
                            {"analysis", stiffCase.analysis},
                            {"moved", toJson(stiffCase.moved)},
                            {"imported", stiffCase.isImported},
                            {"known", knownToJson(stiffCase.known)},
                            {"most_lobes", foam.lobeCount},
                            {"cells", std::move(cells)},
                            {"views", WrittenJson::parse(*views)["views"]}};
  std::string text;
  print(root, 0, text);
  text += '\n';
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  if (const Result<StiffCase> readBack = parseCase(bytes, path.string()); !readBack) {
    return makeError(ErrorKind::kUsage, "%s", readBack.error().message.c_str());
  }
  return writeFileAtomically(path, bytes);
}

}  // namespace froth
